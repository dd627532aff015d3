// FDCAN of G4: a part of the message RAM each, of a fixed layout: 28 and 8 filters, FIFOs of three elements, three buffers.
//
//   FdcanRam ram;                                            // 0x4000A400
//   FdcanG4 can(1, {21, 22}, ram, context);
//
// Law: RM0440 §44; as fdcan.h. Cannot represent, beyond that: transmit events.
#pragma once
#include <utility>

#include "firmware_iface/mcu/stm32/fdcan.h"

namespace omnihil::mcu {

class FdcanG4 final : public Fdcan {
 public:
  FdcanG4(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context);

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
  double divider() const override;
  Filters filters(bool extended) const override;
  Place fifo(unsigned which) const override;
  std::uint32_t second_line() const override;
  std::uint32_t transmit_element(unsigned place) const override { return base_ + 0x278 + 72 * place; }

 private:
  std::uint32_t base_;
};

}  // namespace omnihil::mcu
