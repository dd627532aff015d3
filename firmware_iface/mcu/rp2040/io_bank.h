// IO_BANK0 and PADS_BANK0 of the RP2040: what each of the 30 pins is given to, and its interrupts.
//
//   IoBank io(context);                      // a PinBank: pins GP0 to GP29
//   io.drive_from(IoBank::kSio, out, oe);    // SIO's words; PIO's alike
//   io.inputs();                             // what SIO, PIO and peripherals see
//
// Law: RP2040 datasheet §2.19. Overrides of output, enable and input work for SIO and PIO; other functions' pins are named
// and belong to their blocks. Edges are latched, levels shown; a pin without its input buffer is 0. Interrupts of core 1
// and of the dormant state are kept.
#pragma once
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"
#include "firmware_iface/mcu/stm32/pin_bank.h"

namespace omnihil::mcu::rp2040 {

inline constexpr unsigned kPins = 30;

class IoBank final : public Rp2040Block, public PinBank {
 public:
  enum Function : std::uint8_t {
    kSpi = 1,
    kUart = 2,
    kI2c = 3,
    kPwm = 4,
    kSio = 5,
    kPio0 = 6,
    kPio1 = 7,
    kNone = 31
  };
  explicit IoBank(ChipContext& context);
  void reset() override;

  unsigned function(unsigned pin) const { return function_[pin]; }
  void drive_from(Function from, std::uint32_t out, std::uint32_t enable);
  std::uint32_t inputs() const { return (levels() & seen_) ^ inverted_; }
  // Changes of what inputs() gives, whoever made them.
  void on_input(std::function<void(unsigned pin, bool level)> listener) {
    input_listeners_.push_back(std::move(listener));
  }
  void set_pad(unsigned pin, std::uint32_t pad);  // by PADS_BANK0

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void refresh();
  void apply_outputs();
  void tell_input(unsigned pin);
  std::uint32_t raw(unsigned word) const;
  std::uint32_t shown_interrupts(unsigned word) const;
  void update();

  static constexpr unsigned kWords = 4;  // of interrupts, 8 pins each
  std::array<std::uint8_t, kPins> function_{};
  std::array<std::uint32_t, kPins> pads_{};
  std::array<std::uint32_t, 3> out_{}, enable_{};  // of SIO, PIO0, PIO1
  std::array<std::uint32_t, 3> of_{};              // pins that are theirs
  bool plain_ = true;                              // no override anywhere
  std::uint32_t seen_ = 0, inverted_ = 0;
  std::uint32_t told_ = 0;  // inputs() as its listeners know it
  std::array<std::uint32_t, kWords> edges_{};
  std::vector<std::function<void(unsigned, bool)>> input_listeners_;
  IrqLine line_;
};

class Pads final : public Rp2040Block {
 public:
  Pads(IoBank& io, ChipContext& context);
  void reset() override;

 protected:
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  IoBank& io_;
};

}  // namespace omnihil::mcu::rp2040
