// TIMER of the RP2040: 64 bits of microseconds and four alarms.
//
//   RpTimer timer(watchdog, context);     // counts the watchdog's tick
//
// Law: RP2040 datasheet §4.6: an alarm fires when the low word equals it. Pausing by a debugger is not there.
#pragma once
#include <array>

#include "firmware_iface/mcu/rp2040/watchdog.h"

namespace omnihil::mcu::rp2040 {

class RpTimer final : public Rp2040Block {
 public:
  RpTimer(Watchdog& watchdog, ChipContext& context);
  void reset() override;
  void run_events() override;
  Cycles stable_until(std::uint32_t offset) const override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  std::uint64_t time() const { return count_.at(now()); }
  void follow_rate();
  void plan();
  void update();

  Watchdog& watchdog_;
  TickCount count_;
  std::uint32_t armed_ = 0, latched_high_ = 0, written_low_ = 0;
  std::array<std::uint64_t, 4> due_{};  // of the armed alarms, in ticks
  Interrupts interrupts_;
  std::array<IrqLine, 4> lines_;
  Cycles next_ = kNever;
};

}  // namespace omnihil::mcu::rp2040
