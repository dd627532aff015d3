// Pin changes to interrupts: EXTI with the pin selection of SYSCFG (F1: AFIO).
//
//   Exti exti(syscfg, {{0, 0, 6}, …, {5, 9, 23}, {10, 15, 40}}, kExtiUsual, context);  // lines first..last -> interrupt
//   exti.pin_changed(port, pin, level);                                // from the GPIO ports
//
// Lines 0..15 (pins). The lines above them (RTC, comparators, USB) are kept in their registers, and never
// rise by themselves. Events (EMR) wake WFE of the core through the pending interrupt only.
#pragma once
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

// Whose registers the pin selection has. kUsual: MEM_MODE is followed: 0 flash, 1 system memory, 3 SRAM at address 0.
enum class SyscfgFamily : std::uint8_t { kUsual, kF1, kF7, kG0, kH7, kL4 };

class Syscfg final : public RegisterBlock {
 public:
  Syscfg(ChipContext& context, SyscfgFamily family);
  unsigned port_of(unsigned line) const { return value(0x08 + 4 * (line / 4)) >> (4 * (line % 4)) & 15u; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  SyscfgFamily family_;
};

struct ExtiVector {
  unsigned first, last;
  int irq;
};

// Where its registers of lines 0 to 31 are.
struct ExtiMap {
  std::span<const RegisterInfo> registers;
  std::uint16_t imr, emr, rtsr, ftsr, swier, pr;
  // G0: edges that fell are pending in a register of their own, SWIER reads 0, and the ports are chosen here.
  std::uint16_t fallen = 0, ports = 0;
};
extern const ExtiMap kExtiUsual, kExtiG0, kExtiH7;

class Exti final : public RegisterBlock {
 public:
  Exti(const Syscfg& syscfg, std::vector<ExtiVector> vectors, const ExtiMap& map, ChipContext& context);
  void reset() override;
  void pin_changed(unsigned port, unsigned pin, bool level);

 protected:
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void raise(std::uint32_t lines, bool fell = false);
  unsigned port_of(unsigned line) const;
  void update();

  const ExtiMap& map_;
  const Syscfg& syscfg_;
  std::vector<ExtiVector> vectors_;
  std::vector<IrqLine> lines_;
  TriggerBus& triggers_;
  int trigger_[16];
};

}  // namespace omnihil::mcu
