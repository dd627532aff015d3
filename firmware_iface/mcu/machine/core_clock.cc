#include "firmware_iface/mcu/machine/core_clock.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint64_t kFsPerNs = 1'000'000, kFsPerSecond = 1'000'000'000'000'000;

}  // namespace

void CoreClock::change(Cycles at, std::uint64_t hz) {
  if (stretches_.empty()) {
    stretches_.push_back({at, hz, 0});
  } else if (stretches_.back().hz != hz) {
    stretches_.push_back({at, hz, to_fs(stretches_.back(), at)});
  }
}

std::int64_t CoreClock::to_ns(Cycles at) const {
  std::size_t i = stretches_.size() - 1;
  while (i > 0 && stretches_[i].begin > at) --i;
  return static_cast<std::int64_t>(to_fs(stretches_[i], at) / kFsPerNs);
}

Cycles CoreClock::from_ns(std::int64_t at_ns) const {
  if (at_ns <= 0) return 0;
  const Wide at_fs = Wide{static_cast<std::uint64_t>(at_ns)} * kFsPerNs;
  std::size_t i = stretches_.size() - 1;
  while (i > 0 && stretches_[i].begin_fs > at_fs) --i;
  const Stretch& stretch = stretches_[i];
  const Wide cycles = ((at_fs - stretch.begin_fs) * stretch.hz + kFsPerSecond - 1) / kFsPerSecond;
  return stretch.begin + static_cast<Cycles>(cycles);
}

}  // namespace omnihil::mcu
