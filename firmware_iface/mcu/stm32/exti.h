// Pin changes to interrupts: EXTI with the pin selection of SYSCFG.
//
//   Exti exti(syscfg, {{0, 0, 6}, …, {5, 9, 23}, {10, 15, 40}}, context);     // lines first..last -> interrupt
//   exti.pin_changed(port, pin, level);                                // from the GPIO ports
//
// Lines 0..15 (pins). The lines above them (RTC, comparators, USB) are kept in their registers, and never
// rise by themselves. Events (EMR) wake WFE of the core through the pending interrupt only.
#pragma once
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class Syscfg final : public RegisterBlock {
 public:
  // `remaps_zero`: MEM_MODE says what address 0 shows; F7 has none, there is RAM of its own.
  Syscfg(ChipContext& context, bool remaps_zero);
  unsigned port_of(unsigned line) const { return value(0x08 + 4 * (line / 4)) >> (4 * (line % 4)) & 15u; }

  // MEM_MODE is followed: 0 flash, 1 system memory, 3 SRAM at address 0.
 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  bool remaps_zero_;
};

struct ExtiVector {
  unsigned first, last;
  int irq;
};

class Exti final : public RegisterBlock {
 public:
  Exti(const Syscfg& syscfg, std::vector<ExtiVector> vectors, ChipContext& context);
  void reset() override;
  void pin_changed(unsigned port, unsigned pin, bool level);

 protected:
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void raise(std::uint32_t lines);
  void update();

  const Syscfg& syscfg_;
  std::vector<ExtiVector> vectors_;
  std::vector<IrqLine> lines_;
  TriggerBus& triggers_;
  int trigger_[16];
};

}  // namespace omnihil::mcu
