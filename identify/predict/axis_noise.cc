#include <algorithm>
#include <cmath>

#include "identify/predict/axis_setup.h"
#include "identify/record/quantum.h"
#include "identify/record/statistics.h"

namespace omnihil {
NoiseEstimate estimate_noise(const std::vector<double>& values) {
  const std::vector<double> finite = finite_values(values);
  NoiseEstimate out;
  if (finite.size() < 4) return out;
  std::vector<double> second;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double d = values[i + 1] - 2.0 * values[i] + values[i - 1];
    if (std::isfinite(d)) second.push_back(std::abs(d));
  }
  out.quantum = quantum_of(finite);
  // white noise: variance of the second difference is 6 sigma^2
  const double robust = sigma_by_mad(std::move(second)) / std::sqrt(6.0);
  double mean = 0.0, square = 0.0;
  for (const double v : finite) mean += v / static_cast<double>(finite.size());
  for (const double v : finite) square += (v - mean) * (v - mean) / static_cast<double>(finite.size());
  out.sigma = std::max({robust, out.quantum / std::sqrt(12.0), kLeastNoiseShare * std::sqrt(square)});
  return out;
}

}  // namespace omnihil
