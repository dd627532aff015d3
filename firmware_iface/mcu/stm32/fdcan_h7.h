// FDCAN of H7: a message RAM that the image lays out, shared by all, with buffers besides the FIFOs.
//
//   FdcanRam ram(10 * 1024);
//   FdcanH7 can(1, {19, 21}, ram, context);
//
// Law: RM0433 §56 (Bosch M_CAN 3.2); as fdcan.h. Lists of filters, two receive FIFOs of up to 64 elements, dedicated receive
// and transmit buffers, transmit FIFO or queue, transmit events. Cannot represent, beyond that: time-triggered operation,
// calibration of the clock.
#pragma once
#include <utility>

#include "firmware_iface/mcu/stm32/fdcan.h"

namespace omnihil::mcu {

class FdcanH7 final : public Fdcan {
 public:
  FdcanH7(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context);
  void reset() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
  Filters filters(bool extended) const override;
  Place fifo(unsigned which) const override;
  void put_in_buffer(const CanFrame& frame, const Verdict& verdict) override;
  std::uint32_t second_line() const override;
  std::uint32_t transmit_element(unsigned place) const override;
  unsigned transmit_room() const override;
  unsigned dedicated() const override;
  void transmitted(unsigned place) override;

 private:
  std::uint32_t part(std::uint16_t reg) const {
    return value(reg) & 0xFFFCu;
  }  // where a part of the RAM begins
  unsigned fifo_places(unsigned fifo) const;
  unsigned queue_places() const;  // behind the dedicated buffers
  unsigned first_free() const;    // of the queue; all of them: none
  std::uint32_t queue_status() const;

  Fifo events_;
  unsigned last_queued_ = 0;  // place of the FIFO asked for last
};

}  // namespace omnihil::mcu
