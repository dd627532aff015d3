// One port of 16 pins: modes, input, output, set/reset; registers of F1 (RM0008 §9) or of all later families (RM0090 §8).
//
//   port.drive(3, true);                                   // the outside pulls pin 3 high, at system.now()
//   port.on_output(13, [](bool level) { … });              // called at every change of what the pin gives
//   port.mode(8) == PinMode::kAlternate;
//
// A pin that nobody drives reads its pull-up (1) or else 0. Cannot represent: open-drain against an outside
// driver, slew rate, analogue levels between 0 and 1, which alternate function a pin has.
#pragma once
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

enum class PinMode : std::uint8_t { kInput, kOutput, kAlternate, kAnalog };

enum class GpioLayout : std::uint8_t { kModes, kF1 };

class GpioPort final : public RegisterBlock {
 public:
  // `port`: 0 for A. Pins A13..A15 and B3, B4 start as debug pins.
  GpioPort(unsigned port, ChipContext& context, GpioLayout layout = GpioLayout::kModes);
  void reset() override;

  unsigned port() const { return port_; }
  PinMode mode(unsigned pin) const { return static_cast<PinMode>(modes_ >> (2 * pin) & 3u); }
  bool output(unsigned pin) const { return (odr_ >> pin & 1u) != 0; }
  bool level(unsigned pin) const;  // what a voltmeter at the pin would say
  void drive(unsigned pin, bool level);
  void release(unsigned pin);
  // Whatever the firmware makes of an output pin: level while it is an output; modes other than output count
  // as low.
  void on_output(unsigned pin, std::function<void(bool)> listener);
  // Level changes of any pin, whoever made them (EXTI).
  void on_level(std::function<void(unsigned port, unsigned pin, bool level)> listener) {
    on_level_ = std::move(listener);
  }
  // The same for whoever draws them: levels after a change, a bit per pin.
  void watch_levels(std::function<void(std::uint32_t levels)> watcher) { watcher_ = std::move(watcher); }
  // Modes, outputs, alternate functions may have changed (boards that look at pin modes).
  void on_modes(std::function<void()> listener) { on_modes_.push_back(std::move(listener)); }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void changed();
  void note_modes();
  std::uint32_t levels() const;

  void store_f1(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes);

  unsigned port_;
  GpioLayout layout_;
  std::uint32_t odr_ = 0;                   // the output data register
  std::uint32_t modes_ = 0;                 // two bits a pin, as MODER has them
  std::uint32_t outputs_ = 0, pulled_ = 0;  // of the registers, a bit per pin
  std::uint32_t driven_ = 0, driven_high_ = 0;
  std::uint32_t seen_levels_ = 0, seen_outputs_ = 0;
  std::vector<std::pair<unsigned, std::function<void(bool)>>> listeners_;
  std::function<void(unsigned, unsigned, bool)> on_level_;
  std::function<void(std::uint32_t)> watcher_;
  std::vector<std::function<void()>> on_modes_;
};

}  // namespace omnihil::mcu
