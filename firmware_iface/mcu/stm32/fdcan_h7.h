// FDCAN of H7: a message RAM that the image lays out, shared by all, with buffers besides the FIFOs.
//
//   FdcanRam ram(10 * 1024);
//   FdcanH7 can(1, {19, 21}, ram, context);
//
// Law: RM0433 §56 (Bosch M_CAN 3.2). Lists of filters, two receive FIFOs of up to 64 elements, dedicated receive and transmit
// buffers, transmit FIFO or queue; bit time as fdcan.h, of the kernel clock. Cannot represent: what can.h says; time stamps,
// high-priority messages, restricted operation, time-triggered operation, calibration of the clock.
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/fdcan.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class FdcanH7 final : public RegisterBlock, public CanPort {
 public:
  FdcanH7(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context);
  void reset() override;
  void run_events() override;

 protected:
  void take(const CanFrame& frame) override;
  double bit_cycles() const override;
  Cycles present() const override { return now(); }
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Fifo {
    unsigned get = 0, fill = 0;
    bool lost = false;
  };
  enum class To : std::uint8_t { kNobody, kFifo0, kFifo1, kBuffer };
  struct Verdict {
    To to = To::kNobody;
    unsigned index = 0, buffer = 0;
    bool matched = false;
  };
  bool running() const { return (value(0x18) & 1u) == 0; }
  std::uint32_t part(std::uint16_t reg) const {
    return value(reg) & 0xFFFCu;
  }  // where a part of the RAM begins
  double core_cycles(double clocks) const;
  unsigned fifo_places(unsigned fifo) const;
  unsigned buffers() const;       // dedicated ones
  unsigned queue_places() const;  // behind them
  unsigned first_free() const;    // of the queue; all of them: none
  CanFrame buffer(unsigned place) const;
  Verdict judge(const CanFrame& frame) const;
  void keep_frame(std::uint32_t at, const CanFrame& frame, const Verdict& verdict);
  void log_transmitted(unsigned place);
  void request(std::uint32_t places);
  void cancel(std::uint32_t places);
  void transmit_next();
  void update();

  ChipContext& context_;
  FdcanRam& ram_;
  std::array<Fifo, 2> fifos_;
  Fifo events_;
  std::vector<unsigned> asked_;  // buffers waiting, in the order of the requests
  unsigned last_queued_ = 0;     // place of the FIFO asked for last
  Cycles sent_at_ = kNever;
  IrqLine irq0_, irq1_;
};

}  // namespace omnihil::mcu
