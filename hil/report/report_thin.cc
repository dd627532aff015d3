#include "hil/report/report_thin.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace omnihil {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < left ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

}  // namespace

ThinClock thin_clock(std::span<const double> time_s, std::size_t intervals) {
  ThinClock clock;
  const std::size_t n = time_s.size();
  const double start_s = n > 0 ? time_s.front() : 0.0;
  clock.exact = n <= 2 * intervals || intervals == 0;
  if (clock.exact) {
    for (const double t : time_s) clock.time_s.push_back(t - start_s);
    return clock;
  }
  clock.interval_s = (time_s.back() - start_s) / static_cast<double>(intervals);
  std::size_t i = 0;
  for (std::size_t k = 0; k < intervals; ++k) {
    const double end_s = start_s + clock.interval_s * static_cast<double>(k + 1);
    clock.first.push_back(i);
    while (i < n && (time_s[i] < end_s || k + 1 == intervals)) ++i;
    for (const double part : {0.25, 0.75}) {
      clock.time_s.push_back(clock.interval_s * (static_cast<double>(k) + part));
    }
  }
  clock.first.push_back(n);
  return clock;
}

std::vector<double> thinned(const ThinClock& clock, std::span<const double> values) {
  if (clock.exact) return {values.begin(), values.end()};
  std::vector<double> kept;
  kept.reserve(clock.time_s.size());
  for (std::size_t k = 0; k + 1 < clock.first.size(); ++k) {
    std::size_t least = values.size(), greatest = values.size();
    for (std::size_t i = clock.first[k]; i < std::min(clock.first[k + 1], values.size()); ++i) {
      if (!std::isfinite(values[i])) continue;
      if (least == values.size() || values[i] < values[least]) least = i;
      if (greatest == values.size() || values[i] > values[greatest]) greatest = i;
    }
    const bool some = least < values.size();
    kept.push_back(some ? values[std::min(least, greatest)] : kNone);
    kept.push_back(some ? values[std::max(least, greatest)] : kNone);
  }
  return kept;
}

PackedSeries packed(std::span<const double> values) {
  PackedSeries series;
  bool any = false;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    series.low = any ? std::min(series.low, v) : v;
    series.high = any ? std::max(series.high, v) : v;
    any = true;
  }
  const double range = series.high - series.low;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.size());
  for (const double v : values) {
    std::uint32_t code = 0;
    if (std::isfinite(v)) {
      code =
          range > 0.0 ? 1u + static_cast<std::uint32_t>(std::lround((v - series.low) / range * 65534.0)) : 1u;
    }
    bytes.push_back(static_cast<std::uint8_t>(code & 255u));
    bytes.push_back(static_cast<std::uint8_t>(code >> 8));
  }
  series.base64 = base64(bytes);
  return series;
}

std::string packed_floats(std::span<const double> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * values.size());
  for (const double v : values) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(v));
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<std::uint8_t>(bits >> shift & 255u));
  }
  return base64(bytes);
}

}  // namespace omnihil
