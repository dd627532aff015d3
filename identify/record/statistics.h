// Order statistics of plain samples: median, quantiles, and the robust scale that comes from them.
//
//   double m = median(values);                        // x_(n/2) of x_(0) <= … <= x_(n-1)
//   double s = sigma_by_mad(absolute_deviations);     // 1-sigma of a normal, whatever the outliers do
//   double q = quantile(values, 0.98, QuantileRank::kNearest);
//
// Definitions: for even n the median is the upper of the two middle values, not their mean, so that it is
// always a value that was measured. A quantile is a value of the sample as well (no interpolation); which
// one, its QuantileRank says. Law: for a normal the median of |x - mu| is 0.67449 sigma, Phi^-1(3/4); its
// inverse, 1.4826, makes the median absolute deviation a consistent estimate of sigma (Hampel, J. Am. Stat.
// Assoc. 69, 1974; breakdown point 50 %). Samples: n values of any unit, which the results share; finite
// (leave NaN out first: finite_values).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace omnihil {

// 1 / Phi^-1(3/4) = 1.482602, as Hampel 1974 and R's mad() have it.
inline constexpr double kSigmaPerMad = 1.4826;  // as above

// Index, among n sorted values, of the p quantile.
enum class QuantileRank : std::uint8_t {
  kNearest,  // round(p (n - 1))
  kLower,    // floor(p (n - 1))
  kAbove,    // min(floor(p n), n - 1): at least a share p of the sample is at or below it
};

inline std::size_t quantile_index(std::size_t n, double share, QuantileRank rank) {
  const double last = static_cast<double>(n - 1);
  if (rank == QuantileRank::kNearest) return static_cast<std::size_t>(share * last + 0.5);
  if (rank == QuantileRank::kLower) return static_cast<std::size_t>(share * last);
  return std::min(n - 1, static_cast<std::size_t>(share * static_cast<double>(n)));
}

// The value of this index in sorted order; reorders `values` (0 <= index < n).
inline double order_statistic(std::span<double> values, std::size_t index) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// 0 of no values.
inline double quantile(std::vector<double> values, double share, QuantileRank rank) {
  if (values.empty()) return 0.0;
  return order_statistic(values, quantile_index(values.size(), share, rank));
}

// 0 of no values; reorders them, allocates nothing.
inline double median_in_place(std::span<double> values) {
  return values.empty() ? 0.0 : order_statistic(values, values.size() / 2);
}
inline double median(std::vector<double> values) { return median_in_place(values); }

// 1-sigma of a normal from the sizes |x - mu| of n deviations; 0 of none.
inline double sigma_by_mad(std::vector<double> absolute_deviations) {
  return kSigmaPerMad * median_in_place(absolute_deviations);
}

// Root mean square about the mean; 0 of no values.
inline double rms_about_mean(std::span<const double> values) {
  double mean = 0.0, square = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) square += (v - mean) * (v - mean) / static_cast<double>(values.size());
  return std::sqrt(square);
}

// The largest |v|, of those that are finite; 0 of none.
inline double largest_size(std::span<const double> values) {
  double largest = 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
  }
  return largest;
}

inline std::vector<double> finite_values(std::span<const double> values) {
  std::vector<double> out;
  for (const double v : values) {
    if (std::isfinite(v)) out.push_back(v);
  }
  return out;
}

}  // namespace omnihil
