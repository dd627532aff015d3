// Cycles of the core clock and time since power-on, both ways, over changes of the clock's rate.
//
//   CoreClock clock(16'000'000);
//   clock.change(cycles, 168'000'000);
//   clock.to_ns(cycles + 168) == clock.to_ns(cycles) + 1000;
//
// Within a stretch of one rate the conversion is exact (integers); where the rate changes the instant is kept
// in femtoseconds, rounded down.
#pragma once
#include <cstdint>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

class CoreClock {
 public:
  explicit CoreClock(std::uint64_t hz) { change(0, hz); }
  // From cycle `at` on; not before the last change.
  void change(Cycles at, std::uint64_t hz);
  std::uint64_t hz() const { return stretches_.back().hz; }
  std::int64_t to_ns(Cycles at) const;       // rounded down
  Cycles from_ns(std::int64_t at_ns) const;  // the first cycle not before it

 private:
  __extension__ using Wide = unsigned __int128;
  struct Stretch {
    Cycles begin;
    std::uint64_t hz;
    Wide begin_fs;
    std::uint64_t begin_ns, begin_rest_fs;  // the same, in two parts
    std::uint64_t inverse;                  // 2^64 / hz, rounded down
  };
  Wide to_fs(const Stretch& stretch, Cycles at) const {
    return stretch.begin_fs + Wide{at - stretch.begin} * 1'000'000'000'000'000u / stretch.hz;
  }
  // value / hz; `value` becomes the rest.
  static std::uint64_t divide(std::uint64_t& value, const Stretch& stretch) {
    auto quotient =
        static_cast<std::uint64_t>(Wide{value} * stretch.inverse >> 64);  // too small by 2 at most
    value -= quotient * stretch.hz;
    for (; value >= stretch.hz; value -= stretch.hz) ++quotient;
    return quotient;
  }
  std::vector<Stretch> stretches_;
  std::int64_t find_ns(Cycles at) const;
  std::int64_t ns_from(Cycles begin, std::uint64_t begin_ns, const Stretch& stretch, Cycles at) const;
  mutable Cycles asked_ = 0;  // last, of to_ns(): several ask at one instant
  mutable std::int64_t answered_ns_ = -1;
  // Of the last stretch, a whole number of seconds from its begin: most ask within the second after it.
  mutable Cycles second_ = 0;
  mutable std::uint64_t second_ns_ = 0;
};

}  // namespace omnihil::mcu
