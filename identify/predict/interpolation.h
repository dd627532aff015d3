// Values between the samples of a clock: on straight lines, and outside of it those of its ends.
//
//   Instant<Jet> at = instant(time_s, age_s);                   // a time that may carry derivatives
//   Jet y = at.of([&](std::size_t k) { return values[k]; });
//   std::vector<double> even = resampled(time_s, values, clock);      // over missing values (NaN) as well
//   std::vector<double> angle_rad = integrated(time_s, values, 0.01);
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct Instant {
  std::size_t from = 0;     // sample; between this and the next one
  bool is_between = false;  // false: at that sample, whatever the derivatives
  T share = T(0);           // of the way to the next

  template <typename Values>
  auto of(const Values& values) const {
    using Out = decltype(values(from) * share);
    return is_between ? Out(values(from) + (values(from + 1) - values(from)) * share) : Out(values(from));
  }
};

template <typename T>
Instant<T> instant(const std::vector<double>& time_s, const T& at_s) {
  const double now_s = value_of(at_s);
  if (now_s < time_s.front() || time_s.size() < 2) return {};
  if (now_s > time_s.back()) return {.from = time_s.size() - 1};
  const auto after = std::upper_bound(time_s.begin(), time_s.end() - 1, now_s);
  const auto k = static_cast<std::size_t>(after - time_s.begin());
  return {k - 1, true, T((at_s - time_s[k - 1]) / (time_s[k] - time_s[k - 1]))};
}

// A signal's known values; those of an empty one, or of one that is never known, are none.
struct KnownValues {
  std::vector<double> time_s, value;

  KnownValues(const std::vector<double>& all_s, const std::vector<double>& all) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (std::isfinite(all[k])) time_s.push_back(all_s[k]), value.push_back(all[k]);
    }
  }
  // The last of them at this time, or `late_s` after it; before the first that one.
  double held_at(double at_s, double late_s) const {
    const auto after = std::upper_bound(time_s.begin(), time_s.end(), at_s + late_s);
    return value[after == time_s.begin() ? 0 : static_cast<std::size_t>(after - time_s.begin()) - 1];
  }
  double line_at(double at_s) const {
    return instant(time_s, at_s).of([&](std::size_t k) { return value[k]; });
  }
};

// On another clock, at(known, time) each; empty where nothing is known.
template <typename At>
std::vector<double> resampled(const std::vector<double>& time_s, const std::vector<double>& values,
                              const std::vector<double>& clock, At at) {
  const KnownValues known(time_s, values);
  std::vector<double> out;
  for (std::size_t k = 0; k < clock.size() && !known.value.empty(); ++k) out.push_back(at(known, clock[k]));
  return out;
}
inline std::vector<double> resampled(const std::vector<double>& time_s, const std::vector<double>& values,
                                     const std::vector<double>& clock) {
  return resampled(time_s, values, clock, [](const KnownValues& x, double at_s) { return x.line_at(at_s); });
}

// Of a rate since its first sample, which is known, by the trapezoidal rule over missing ones (NaN there as well); NaN from
// the first two samples on that are further apart than `gap_s`.
inline std::vector<double> integrated(const std::vector<double>& time_s, const std::vector<double>& rate,
                                      double gap_s) {
  std::vector<double> out(rate.size(), std::nan(""));
  if (!out.empty()) out[0] = 0.0;
  std::size_t last = 0;
  for (std::size_t k = 1; k < rate.size() && !(time_s[k] - time_s[k - 1] > gap_s); ++k) {
    if (!std::isfinite(rate[k])) continue;
    out[k] = out[last] + 0.5 * (rate[k] + rate[last]) * (time_s[k] - time_s[last]);
    last = k;
  }
  return out;
}

}  // namespace omnihil
