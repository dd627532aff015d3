// What a drive was asked for, and when: a sequence of held values, for effects that act on the past.
//
//   history.push(0.000, 0.2);  history.push(0.001, 0.5);      // 0.2 from 0 on, 0.5 from 1 ms on
//   mean_over(history, Jet(0.0008), 0.0004);                  // over [0.8 ms, 1.2 ms]: 0.35
//
// The mean over an interval is piecewise linear in the interval's place, so a delay has an honest derivative
// at every resolution, which the value at an instant would not have.
// Remembers the last 2048 changes, 0.1 s of them at 20 kHz; before the oldest, its value is taken to have
// held for ever.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "sim/law/scalar.h"

namespace omnihil {

inline constexpr int kCommandChanges = 2048;  // a power of two

struct CommandHistory {
  struct Change {
    double start_s = 0.0;
    double value = 0.0;
  };
  std::array<Change, kCommandChanges> changes{};
  std::uint64_t count = 0;  // ever pushed; the newest is number count - 1

  void push(double start_s, double value) {
    if (count > 0 && newest().value == value) return;
    if (count > 0 && newest().start_s == start_s) {
      changes[(count - 1) % kCommandChanges].value = value;
      return;
    }
    changes[count++ % kCommandChanges] = {start_s, value};
  }
  const Change& newest() const { return changes[(count - 1) % kCommandChanges]; }
  const Change& at(std::uint64_t number) const { return changes[number % kCommandChanges]; }
  std::uint64_t oldest() const { return count > kCommandChanges ? count - kCommandChanges : 0; }
  // What was asked before everything that is remembered; the one value where there is no other.
  double first_value() const { return count > 0 ? at(oldest()).value : 0.0; }
  // The number of the first change at or after a time; `count` if there is none.
  std::uint64_t first_from(double time_s) const {
    std::uint64_t low = oldest(), high = count;
    while (low < high) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (at(middle).start_s < time_s) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }
};

// Mean over [start, start + length] of the held values; the newest holds on. 0 when nothing was asked yet.
template <typename T>
T mean_over(const CommandHistory& history, const T& start_s, double length_s) {
  if (history.count == 0) return T(0);
  const T end_s = start_s + length_s;
  T sum = T(0);
  T segment_end_s = end_s;
  const std::uint64_t oldest = history.oldest();
  for (std::uint64_t n = std::max(history.first_from(value_of(end_s)), oldest + 1); n-- > oldest;) {
    const auto& change = history.at(n);
    const bool first = n == oldest;
    // mean = 1/h sum over segments of value * overlap
    // A change at the very start is parted off with no overlap: its share's derivative is there all the same.
    if (first || change.start_s < value_of(start_s)) {
      sum += (segment_end_s - start_s) * change.value;
      break;
    }
    sum += (segment_end_s - change.start_s) * change.value;
    segment_end_s = T(change.start_s);
  }
  return sum / length_s;
}

}  // namespace omnihil
