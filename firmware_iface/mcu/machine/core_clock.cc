#include "firmware_iface/mcu/machine/core_clock.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint64_t kFsPerNs = 1'000'000;
constexpr std::uint64_t kNsPerSecond = 1'000'000'000;

}  // namespace

void CoreClock::change(Cycles at, std::uint64_t hz) {
  answered_ns_ = -1;
  if (stretches_.empty()) {
    stretches_.push_back({at, hz, 0, 0, 0, ~std::uint64_t{0} / hz});
  } else if (stretches_.back().hz != hz) {
    const Wide fs = to_fs(stretches_.back(), at);
    stretches_.push_back({at, hz, fs, static_cast<std::uint64_t>(fs / kFsPerNs),
                          static_cast<std::uint64_t>(fs % kFsPerNs), ~std::uint64_t{0} / hz});
  }
  second_ = stretches_.back().begin;
  second_ns_ = stretches_.back().begin_ns;
}

// Not more than a second from `begin`, which is begin_ns and the stretch's femtoseconds: with r cycles < hz
// < 1.8e10
//   floor(r 1e15 / hz) = 1e6 floor(r 1e9 / hz) + floor(1e6 (r 1e9 mod hz) / hz)
inline std::int64_t CoreClock::ns_from(Cycles begin, std::uint64_t begin_ns, const Stretch& stretch,
                                       Cycles at) const {
  std::uint64_t r = (at - begin) * kNsPerSecond;
  const std::uint64_t ns = divide(r, stretch);
  // begin_rest_fs + floor(1e6 r / hz) >= 1e6, without the division
  const bool carry = r * kFsPerNs >= (kFsPerNs - stretch.begin_rest_fs) * stretch.hz;
  return static_cast<std::int64_t>(begin_ns + ns + (carry ? 1 : 0));
}

std::int64_t CoreClock::to_ns(Cycles at) const {
  if (at == asked_ && answered_ns_ >= 0) return answered_ns_;
  const Stretch& last = stretches_.back();
  asked_ = at;
  answered_ns_ = at - second_ < last.hz ? ns_from(second_, second_ns_, last, at) : find_ns(at);
  return answered_ns_;
}

std::int64_t CoreClock::find_ns(Cycles at) const {
  std::size_t i = stretches_.size() - 1;
  while (i > 0 && stretches_[i].begin > at) --i;
  const Stretch& stretch = stretches_[i];
  const std::uint64_t seconds = (at - stretch.begin) / stretch.hz;
  const Cycles begin = stretch.begin + seconds * stretch.hz;
  const std::uint64_t begin_ns = stretch.begin_ns + seconds * kNsPerSecond;
  if (i + 1 == stretches_.size()) {
    second_ = begin;
    second_ns_ = begin_ns;
  }
  return ns_from(begin, begin_ns, stretch, at);
}

Cycles CoreClock::from_ns(std::int64_t at_ns) const {
  if (at_ns <= 0) return 0;
  const Wide at_fs = Wide{static_cast<std::uint64_t>(at_ns)} * kFsPerNs;
  std::size_t i = stretches_.size() - 1;
  while (i > 0 && stretches_[i].begin_fs > at_fs) --i;
  const Stretch& stretch = stretches_[i];
  // In 64 bits, as in to_ns(): ceil((1e6 t - begin_rest_fs) hz / 1e15) with t = 1e9 s + r ns, since
  //   ceil((1e6 a - b) / 1e15) = ceil((a - floor(b / 1e6)) / 1e9)
  const std::uint64_t t = static_cast<std::uint64_t>(at_ns) - stretch.begin_ns;
  const std::uint64_t seconds = t / kNsPerSecond * stretch.hz, a = t % kNsPerSecond * stretch.hz;
  const std::uint64_t b = stretch.begin_rest_fs * stretch.hz / kFsPerNs;
  const Cycles begin = stretch.begin + seconds;
  return a > b ? begin + (a - b - 1) / kNsPerSecond + 1 : begin - (b - a) / kNsPerSecond;
}

}  // namespace omnihil::mcu
