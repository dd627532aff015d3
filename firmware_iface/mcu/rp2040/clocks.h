// CLOCKS of the RP2040: which oscillator each clock comes from and by what it is divided.
//
//   Clocks clocks(xosc, rosc, pll_sys, pll_usb, context);
//
// Law: RP2040 datasheet §2.15. clk_sys is the core's clock and the PWM's; ClockTree carries clk_ref (Bus::kReference),
// clk_peri (kPeripheral) and clk_adc (kAdc) as ratios to it. Sources change at once; one that is off is said and the clock
// stays as it was. Not there: inputs from pins, resuscitation, clock gates (WAKE_EN, SLEEP_EN are kept), outputs on pins.
#pragma once
#include "firmware_iface/mcu/rp2040/oscillators.h"

namespace omnihil::mcu::rp2040 {

class Clocks final : public Rp2040Block {
 public:
  Clocks(Xosc& xosc, Rosc& rosc, Pll& sys, Pll& usb, ChipContext& context);
  void reset() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void apply();
  double ref_hz() const;
  double sys_hz() const;
  double divided(double hz, std::uint32_t div) const;
  double auxiliary(std::uint32_t clock, std::span<const char> sources) const;
  double source_hz(char source) const;
  double counted_hz(std::uint32_t source) const;

  ChipContext& context_;
  Xosc& xosc_;
  Rosc& rosc_;
  Pll &pll_sys_, &pll_usb_;
  double ref_hz_ = kRing_hz, sys_hz_ = kRing_hz;  // as they are
};

}  // namespace omnihil::mcu::rp2040
