// A chip's pins as what is around it sees them: what each is, which level it has, who drives it.
//
//   bank.drive(3, true);                                   // the outside pulls pin 3 high, at this instant
//   bank.on_output(13, [](bool level) { … });              // called at every change of what the pin gives
//   bank.mode(8) == PinMode::kAlternate;
//
// A pin that nobody drives reads its pull-up (1) or else 0. Registers are of the block that has the pins: it sets the
// words below and calls changed(). Cannot represent: open-drain against an outside driver, slew rate, analogue levels
// between 0 and 1.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace omnihil::mcu {

enum class PinMode : std::uint8_t { kInput, kOutput, kAlternate, kAnalog };

class PinBank {
 public:
  // 'A' to 'K': a port, of 16 pins named "PA3"; kGp: the chip's one bank, of pins named "GP7".
  static constexpr char kGp = 'g';
  PinBank(char letter, unsigned pins) : letter_(letter), pins_((1u << pins) - 1u) {}
  virtual ~PinBank() = default;

  char letter() const { return letter_; }
  bool has(unsigned pin) const { return pin < 32 && (pins_ >> pin & 1u) != 0; }
  static std::string pin_name(char letter, unsigned pin) {
    return (letter == kGp ? std::string("GP") : std::string("P") + letter) + std::to_string(pin);
  }
  PinMode mode(unsigned pin) const { return static_cast<PinMode>(modes_ >> (2 * pin) & 3u); }
  bool output(unsigned pin) const { return (odr_ >> pin & 1u) != 0; }
  bool level(unsigned pin) const {  // what a voltmeter at the pin would say
    return (levels() >> pin & 1u) != 0;
  }
  std::uint32_t levels() const {  // a bit per pin
    const std::uint32_t idle = (driven_ & driven_high_) | (~driven_ & pulled_);
    return ((outputs_ & odr_) | (~outputs_ & idle)) & pins_;
  }
  void drive(unsigned pin, bool level) {
    driven_ |= 1u << pin;
    driven_high_ = (driven_high_ & ~(1u << pin)) | (level ? 1u << pin : 0u);
    changed();
  }
  void release(unsigned pin) {
    driven_ &= ~(1u << pin);
    changed();
  }
  // Whatever the firmware makes of an output pin: level while it is an output; modes other than output count
  // as low.
  void on_output(unsigned pin, std::function<void(bool)> listener) {
    listeners_.emplace_back(pin, std::move(listener));
  }
  // Level changes of any pin, whoever made them (EXTI). `bank`: 0 for A.
  void on_level(std::function<void(unsigned bank, unsigned pin, bool level)> listener) {
    on_level_ = std::move(listener);
  }
  // The same for whoever draws them: levels after a change, a bit per pin.
  void watch_levels(std::function<void(std::uint32_t levels)> watcher) { watcher_ = std::move(watcher); }
  // Modes, outputs, alternate functions may have changed (boards that look at pin modes).
  void on_modes(std::function<void()> listener) { on_modes_.push_back(std::move(listener)); }

 protected:
  void changed() {
    const std::uint32_t levels_now = levels(), outputs = outputs_ & odr_;
    const std::uint32_t moved = levels_now ^ seen_levels_, given = outputs ^ seen_outputs_;
    seen_levels_ = levels_now;
    seen_outputs_ = outputs;
    if (moved != 0 && watcher_) watcher_(levels_now);
    for (unsigned pin = 0; moved >> pin != 0 && on_level_; ++pin) {
      if ((moved >> pin & 1u) != 0)
        on_level_(static_cast<unsigned>(letter_ - 'A'), pin, (levels_now >> pin & 1u) != 0);
    }
    if (given == 0) return;
    for (const auto& [pin, listener] : listeners_) {
      if ((given >> pin & 1u) != 0) listener((outputs >> pin & 1u) != 0);
    }
  }
  void modes_changed() const {
    for (const auto& listener : on_modes_) listener();
  }

  std::uint64_t modes_ = 0;                 // two bits a pin, as MODER has them
  std::uint32_t odr_ = 0;                   // what its output driver is given
  std::uint32_t outputs_ = 0, pulled_ = 0;  // a bit per pin: its driver is on; it has a pull-up

 private:
  char letter_;
  std::uint32_t pins_;
  std::uint32_t driven_ = 0, driven_high_ = 0;
  std::uint32_t seen_levels_ = 0, seen_outputs_ = 0;
  std::vector<std::pair<unsigned, std::function<void(bool)>>> listeners_;
  std::function<void(unsigned, unsigned, bool)> on_level_;
  std::function<void(std::uint32_t)> watcher_;
  std::vector<std::function<void()>> on_modes_;
};

}  // namespace omnihil::mcu
