// One port of 16 pins: modes, input, output, set/reset; registers of F1 (RM0008 §9) or of all later families (RM0090 §8).
//
//   GpioPort port(0, context);                             // GPIOA
//
// What is around the chip sees the pins by PinBank. Cannot represent: which alternate function a pin has.
#pragma once
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/pin_bank.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

enum class GpioLayout : std::uint8_t { kModes, kF1 };

class GpioPort final : public RegisterBlock, public PinBank {
 public:
  // `port`: 0 for A. Pins A13..A15 and B3, B4 start as debug pins.
  GpioPort(unsigned port, ChipContext& context, GpioLayout layout = GpioLayout::kModes);
  void reset() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void note_modes();
  void store_f1(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes);

  unsigned port_;
  GpioLayout layout_;
};

}  // namespace omnihil::mcu
