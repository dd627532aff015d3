// WATCHDOG of the RP2040, and its tick, which TIMER counts too.
//
//   watchdog.tick();                 // ticks per cycle of the core: 12 MHz / 12 at 125 MHz: {1, 125}
//   watchdog.on_tick([] { … });      // it has another rate, or stands
//
// Law: RP2040 datasheet §4.7: tick = clk_ref / CYCLES; CTRL.TIME falls by 2 a tick, as the chip does it (erratum E1), and
// at 0 the chip is reset. SCRATCH0 to 7 live over resets but the power-on. Every watchdog reset is one of the whole chip,
// whatever PSM_WDSEL says.
#pragma once
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"

namespace omnihil::mcu::rp2040 {

// Ticks counted at a rate that may change; parts of a tick live as long as the rate.
class TickCount {
 public:
  void set(std::uint64_t ticks, Cycles at) { ticks_ = ticks, rest_ = 0, since_ = at; }
  void rate(ClockRatio rate, Cycles at) {
    bring(at);
    if (!(rate == rate_)) rest_ = 0;
    rate_ = rate;
  }
  std::uint64_t at(Cycles at) const { return ticks_ + (rest_ + (at - since_) * rate_.mul) / rate_.div; }
  // When it is `ticks`, not before `from`; kNever while it stands.
  Cycles when(std::uint64_t ticks, Cycles from) const {
    if (rate_.mul == 0) return kNever;
    if (ticks <= at(from)) return from;
    const std::uint64_t parts = (ticks - ticks_) * rate_.div - rest_;
    return since_ + (parts + rate_.mul - 1) / rate_.mul;
  }

 private:
  void bring(Cycles at) {
    const std::uint64_t parts = rest_ + (at - since_) * rate_.mul;
    ticks_ += parts / rate_.div;
    rest_ = parts % rate_.div;
    since_ = at;
  }
  ClockRatio rate_{0, 1};
  std::uint64_t ticks_ = 0, rest_ = 0;  // rest_ in parts of 1 / rate_.div
  Cycles since_ = 0;
};

class Watchdog final : public Rp2040Block {
 public:
  explicit Watchdog(ChipContext& context);
  void reset() override;
  void run_events() override;
  void clock_changed() override;
  Cycles stable_until(std::uint32_t) const override { return 0; }

  ClockRatio tick() const;  // {0, 1}: it stands
  void on_tick(std::function<void()> listener) { listeners_.push_back(std::move(listener)); }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void run_or_pause();
  void plan();
  std::uint32_t left() const;

  ChipContext& context_;
  TickCount count_;
  std::uint64_t end_ = 0;  // in ticks
  Cycles next_ = kNever;
  std::array<std::uint32_t, 8> scratch_{};
  std::vector<std::function<void()>> listeners_;
};

}  // namespace omnihil::mcu::rp2040
