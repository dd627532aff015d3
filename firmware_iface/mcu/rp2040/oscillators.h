// Crystal oscillator, ring oscillator and the two PLLs of the RP2040.
//
//   Pll pll("PLL_SYS", context);
//   pll.hz(12e6);                  // 125e6 with FBDIV 125, POSTDIV 6 and 2
//
// Law: RP2040 datasheet §2.16 to §2.18: output = crystal / REFDIV * FBDIV / (POSTDIV1 * POSTDIV2). All are ready at once;
// the ring oscillator has its nominal 6.5 MHz whatever its drive strengths are. Dormant mode is not there.
#pragma once
#include <functional>
#include <utility>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"

namespace omnihil::mcu::rp2040 {

inline constexpr double kRing_hz = 6.5e6;  // datasheet §2.17: nominal after reset, 1.8 to 12 MHz

// One that CLOCKS has to hear of.
class ClockSource : public Rp2040Block {
 public:
  using Rp2040Block::Rp2040Block;
  void on_change(std::function<void()> listener) { listener_ = std::move(listener); }

 protected:
  void changed() const {
    if (listener_) listener_();
  }

 private:
  std::function<void()> listener_;
};

class Xosc final : public ClockSource {
 public:
  explicit Xosc(ChipContext& context);
  bool running() const;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
};

class Rosc final : public ClockSource {
 public:
  explicit Rosc(ChipContext& context);
  bool running() const;
  Cycles stable_until(std::uint32_t offset) const override { return offset == 0x1C ? 0 : kNever; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  std::uint32_t noise_ = 1;
};

class Pll final : public ClockSource {
 public:
  Pll(std::string name, ChipContext& context);
  double hz(double crystal_hz) const;  // 0: it is off

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
};

}  // namespace omnihil::mcu::rp2040
