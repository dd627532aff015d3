#include <algorithm>
#include <cmath>

#include "identify/predict/axis_setup.h"

namespace omnihil {
namespace {

double median(std::vector<double> v) {
  if (v.empty()) return 0.0;
  const auto mid = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), mid, v.end());
  return *mid;
}

// Smallest step between the values of a record that has few different ones.
double quantum_of(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  const double range = v.back() - v.front();
  const double least = 1e-7 * range;
  double smallest = range;
  std::size_t different = 1;
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double step = v[i] - v[i - 1];
    if (step <= least) continue;
    ++different;
    smallest = std::min(smallest, step);
  }
  return different * 3 < v.size() && different > 1 ? smallest : 0.0;
}

}  // namespace

NoiseEstimate estimate_noise(const std::vector<double>& values) {
  std::vector<double> finite;
  for (const double v : values) {
    if (std::isfinite(v)) finite.push_back(v);
  }
  NoiseEstimate out;
  if (finite.size() < 4) return out;
  std::vector<double> second;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double d = values[i + 1] - 2.0 * values[i] + values[i - 1];
    if (std::isfinite(d)) second.push_back(std::abs(d));
  }
  out.quantum = quantum_of(finite);
  // white noise: variance of the second difference is 6 sigma^2; 1.4826 median of the absolute: sigma of a
  // normal
  const double robust = 1.4826 * median(second) / std::sqrt(6.0);
  double mean = 0.0, square = 0.0;
  for (const double v : finite) mean += v / static_cast<double>(finite.size());
  for (const double v : finite) square += (v - mean) * (v - mean) / static_cast<double>(finite.size());
  constexpr double kLeastShare = 1e-4;  // no sensor is better than this share of its signal: a guess
  out.sigma = std::max({robust, out.quantum / std::sqrt(12.0), kLeastShare * std::sqrt(square)});
  return out;
}

}  // namespace omnihil
