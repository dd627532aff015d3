// How a timer counts: positions in one period, from which count, direction and update instants follow.
//
//   CounterLaw law{CounterLaw::Way::kCentre, 999};
//   law.period();           // 1998 ticks
//   law.count(1200);        // 798, counting down
//
// Law (RM0090 §17.3.2): up 0..ARR, down ARR..0: ARR + 1 ticks, an update at each wrap; centre-aligned
// 0..ARR-1, ARR..1: 2 ARR ticks, an update at either end. Validity: ARR > 0 (a counter with ARR = 0 stands
// still).
#pragma once
#include <algorithm>
#include <cstdint>

namespace omnihil::mcu {

struct CounterLaw {
  enum class Way : std::uint8_t { kUp, kDown, kCentre };
  Way way = Way::kUp;
  std::uint64_t arr = 0xFFFF;

  std::uint64_t period() const { return way == Way::kCentre ? std::max<std::uint64_t>(2 * arr, 1) : arr + 1; }
  bool falling(std::uint64_t position) const {
    return way == Way::kDown || (way == Way::kCentre && position >= arr);
  }
  std::uint64_t count(std::uint64_t position) const {
    if (way == Way::kDown) return arr - position;
    return way == Way::kCentre && position > arr ? 2 * arr - position : position;
  }
  // Of a count within 0..ARR.
  std::uint64_t position(std::uint64_t count, bool down) const {
    count = std::min(count, arr);
    if (way == Way::kDown) return arr - count;
    return way == Way::kCentre && down && count > 0 ? 2 * arr - count : count;
  }
  // Ticks from here to the next end of the count, at least 1.
  std::uint64_t to_boundary(std::uint64_t position) const {
    return way == Way::kCentre && position < arr ? arr - position : period() - position;
  }
  // Ticks from here until `target` is reached, at least 1.
  std::uint64_t to_position(std::uint64_t position, std::uint64_t target) const {
    const std::uint64_t p = period();
    return (target % p + p - position - 1) % p + 1;
  }
  // PWM mode 1: active while CNT < CCR counting up, while CNT <= CCR counting down.
  static bool pwm_active(bool falling, std::uint64_t count, std::uint64_t ccr) {
    return falling ? count <= ccr : count < ccr;
  }
  // Share of the period for which pwm_active().
  double pwm_ratio(std::uint64_t ccr) const {
    const std::uint64_t all = way == Way::kCentre ? arr : arr + 1;
    const std::uint64_t active = way == Way::kDown ? ccr + 1 : ccr;
    if (active >= all) return 1.0;
    return static_cast<double>(static_cast<std::int64_t>(active)) /
           static_cast<double>(static_cast<std::int64_t>(all));  // both below 2^33: signed converts faster
  }
};

}  // namespace omnihil::mcu
