// SIO of the RP2040: what each core reaches in one cycle. Of core 0: the other one stays in the boot ROM.
//
//   Sio sio(io, context);
//
// Law: RP2040 datasheet §2.3.1: GPIO words with set, clear and exclusive or; FIFOs between the cores; 32 spinlocks; the
// divider, whose result is there at once (8 cycles on the chip, for which every program waits); interpolators are in
// interpolator.h. Core 1 answers the words that launch it as its boot ROM does (§2.8.2), and that it does not run then is
// reported. GPIO_HI (flash pins) is kept.
#pragma once
#include <array>
#include <deque>

#include "firmware_iface/mcu/rp2040/interpolator.h"
#include "firmware_iface/mcu/rp2040/io_bank.h"

namespace omnihil::mcu::rp2040 {

struct Division {
  std::uint32_t quotient = 0, remainder = 0;
};
// As the divider does it, by zero too (§2.3.1.5).
Division divide(std::uint32_t dividend, std::uint32_t divisor, bool with_sign);

class Sio final : public RegisterBlock {
 public:
  Sio(IoBank& io, ChipContext& context);
  void reset() override;
  Cycles stable_until(std::uint32_t offset) const override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  std::uint32_t fifo_status() const;
  void to_core_1(std::uint32_t word);
  void store_divider(std::uint32_t offset, std::uint32_t written);
  void update();

  IoBank& io_;
  std::uint32_t out_ = 0, enable_ = 0;
  std::uint32_t locks_ = 0;
  std::uint32_t dividend_ = 0, divisor_ = 0;
  bool signed_ = false, dirty_ = false;
  Division result_;
  std::deque<std::uint32_t> from_1_, to_1_;
  std::uint32_t fifo_errors_ = 0;  // WOF, ROE in their places
  unsigned launch_step_ = 0;       // words of the launch that core 1 has taken
  std::array<Interpolator, 2> interpolators_{Interpolator(0), Interpolator(1)};
  IrqLine line_;
};

}  // namespace omnihil::mcu::rp2040
