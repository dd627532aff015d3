#include "identify/record/band_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/record/statistics.h"

namespace omnihil {

double white_noise(const std::vector<double>& samples, const std::vector<double>& low, double band) {
  std::vector<double> above;
  for (std::size_t i = 0; i < samples.size(); ++i) above.push_back(std::abs(samples[i] - low[i]));
  return above.empty() ? 0.0 : sigma_by_mad(std::move(above)) / std::sqrt(1.0 - band);
}

double kept_of_samples(double band) { return band; }
double kept_of_means(double band) {
  const auto cosine = [&](double n) {
    return std::sin(n * std::numbers::pi * band) / (n * std::numbers::pi);
  };
  return (169.0 * (band + cosine(1.0)) + band + cosine(3.0) - 26.0 * (cosine(1.0) + cosine(2.0))) / 288.0;
}

double needed_torque_sigma(const std::vector<double>& speed_error, double inertia_kg_m2,
                           const LowPass& motion, const LowPass& filter, double rate_Hz) {
  double square = 0.0;
  const double count = static_cast<double>(speed_error.size());
  for (std::size_t k = 0; k < speed_error.size(); ++k) {
    const double share = static_cast<double>(k) / (count - 1.0);
    const double slope = 2.0 * rate_Hz * std::sin(0.5 * std::numbers::pi * share);
    const double gain = zero_phase_gain(motion, share) * zero_phase_gain(filter, share);
    square += speed_error[k] * std::pow(slope * gain, 2) / count;
  }
  return inertia_kg_m2 * std::sqrt(std::max(0.0, square));
}

}  // namespace omnihil
