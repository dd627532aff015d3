#include "firmware_iface/mcu/rp2040/interpolator.h"

namespace omnihil::mcu::rp2040 {
namespace {
// CTRL: SHIFT 4:0, MASK_LSB 9:5, MASK_MSB 14:10, then single bits.
enum : unsigned { kSigned = 15, kCrossInput = 16, kCrossResult = 17, kAddRaw = 18, kForceMsb = 19 };
constexpr std::uint32_t kOverflows = 7u << 23;
}  // namespace

Interpolator::Masked Interpolator::masked(unsigned lane) const {
  const std::uint32_t c = control_[lane];
  const std::uint32_t in = accumulator_[control(lane, kCrossInput) ? 1 - lane : lane] >> (c & 31u);
  const unsigned low = c >> 5 & 31u, high = c >> 10 & 31u;
  const std::uint32_t mask = low > high ? 0u : (0xFFFFFFFFu >> (31 - high)) & (0xFFFFFFFFu << low);
  std::uint32_t value = in & mask;
  const std::uint32_t above = high == 31 ? 0u : 0xFFFFFFFFu << (high + 1);
  if (control(lane, kSigned) && (value >> high & 1u) != 0) value |= above;
  return {value, (in & above) != 0};
}

Interpolator::Results Interpolator::results() const {
  Results r{};
  std::uint32_t parts[2];
  for (unsigned lane = 0; lane < 2; ++lane) {
    parts[lane] = masked(lane).value;
    const std::uint32_t added =
        control(lane, kAddRaw) ? accumulator_[control(lane, kCrossInput) ? 1 - lane : lane] : parts[lane];
    r.lane[lane] = base_[lane] + added;
  }
  r.full = base_[2] + parts[0] + parts[1];
  if (clamps()) {
    const bool is_signed = control(0, kSigned);
    const auto less = [is_signed](std::uint32_t a, std::uint32_t b) {
      return is_signed ? static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b) : a < b;
    };
    r.lane[0] = less(parts[0], base_[0]) ? base_[0] : less(base_[1], parts[0]) ? base_[1] : parts[0];
  }
  if (blends()) {
    const std::uint32_t alpha = parts[1] & 0xFFu;
    const bool is_signed = control(1, kSigned);
    const std::int64_t from =
        is_signed ? std::int64_t{static_cast<std::int32_t>(base_[0])} : std::int64_t{base_[0]};
    const std::int64_t to =
        is_signed ? std::int64_t{static_cast<std::int32_t>(base_[1])} : std::int64_t{base_[1]};
    r.lane[0] = alpha;
    r.lane[1] = static_cast<std::uint32_t>(from + (((to - from) * alpha) >> 8));
    r.full = base_[2] + parts[0];
  }
  return r;
}

std::uint32_t Interpolator::read(std::uint32_t offset, bool pops) {
  if (offset < 0x08) return accumulator_[offset / 4];
  if (offset < 0x14) return base_[(offset - 0x08) / 4];
  if (offset < 0x2C) {
    const bool pop = offset < 0x20;
    const unsigned which = (offset - (pop ? 0x14u : 0x20u)) / 4;
    const Results r = results();
    if (pop && pops) {
      for (unsigned lane = 0; lane < 2; ++lane)
        accumulator_[lane] = r.lane[control(lane, kCrossResult) ? 1 - lane : lane];
    }
    // FORCE_MSB is on the bus alone.
    return which < 2 ? r.lane[which] | (control_[which] >> kForceMsb & 3u) << 28 : r.full;
  }
  if (offset == 0x2C) {
    const std::uint32_t over = (masked(0).overflows ? 1u : 0u) | (masked(1).overflows ? 2u : 0u);
    return control_[0] | over << 23 | (over != 0 ? 1u << 25 : 0u);
  }
  if (offset == 0x30) return control_[1];
  return offset < 0x3C ? masked((offset - 0x34) / 4).value : 0;
}

void Interpolator::write(std::uint32_t offset, std::uint32_t value) {
  if (offset < 0x08) {
    accumulator_[offset / 4] = value;
  } else if (offset < 0x14) {
    base_[(offset - 0x08) / 4] = value;
  } else if (offset == 0x2C || offset == 0x30) {
    control_[(offset - 0x2C) / 4] = value & 0x007FFFFFu & ~kOverflows;
  } else if (offset == 0x34 || offset == 0x38) {
    accumulator_[(offset - 0x34) / 4] += value & 0x00FFFFFFu;
  } else if (offset == 0x3C) {  // the halves of the word, with their signs where the lane has one
    for (unsigned lane = 0; lane < 2; ++lane) {
      const std::uint32_t half = value >> (16 * lane) & 0xFFFFu;
      const unsigned by = blends() ? 1 : lane;
      base_[lane] = control(by, kSigned) && (half & 0x8000u) != 0 ? half | 0xFFFF0000u : half;
    }
  }
}

}  // namespace omnihil::mcu::rp2040
