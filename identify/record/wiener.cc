#include "identify/record/wiener.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/record/periodogram.h"
#include "identify/record/statistics.h"

namespace omnihil {
namespace {

// From where on the noise is looked for, of the Nyquist frequency: above the motion.
constexpr double kNoiseFrom = 0.5;  // a choice
// Standard deviations of the periodogram's mean that a frequency has to stand above the noise: a slope multiplies what
// is let through by chance with its frequency. One in 3e4 by chance (normal, one-sided).
constexpr double kAbove_sigmas = 4.0;  // a choice

double shape_of(NoiseSpectrum noise, double share_of_nyquist) {
  const double turn = std::numbers::pi * share_of_nyquist;
  const double slope = (8.0 * std::sin(turn) - std::sin(2.0 * turn)) / 6.0;
  return noise == NoiseSpectrum::kWhite ? 1.0 : slope * slope;
}

// The noise's power at the frequencies of the periodogram.
std::vector<double> noise_of(const Periodogram& periodogram, NoiseSpectrum noise) {
  const std::vector<double>& power = periodogram.power;
  const double top = static_cast<double>(power.size() - 1);
  std::vector<double> level;
  for (std::size_t k = 0; k < power.size(); ++k) {
    const double share = static_cast<double>(k) / top;
    if (share >= kNoiseFrom && share <= kNoiseTo) level.push_back(power[k] / shape_of(noise, share));
  }
  const double size = median(std::move(level)) / median_over_mean(periodogram.segments);
  std::vector<double> out;
  for (std::size_t k = 0; k < power.size(); ++k)
    out.push_back(size * shape_of(noise, static_cast<double>(k) / top));
  return out;
}

// H at the frequencies of the periodogram.
std::vector<double> gain_of(const Periodogram& periodogram, const std::vector<double>& noise_power) {
  const std::vector<double>& power = periodogram.power;
  const double above = 1.0 + kAbove_sigmas * kWelchDeviation / std::sqrt(periodogram.segments);
  std::vector<double> gain;
  for (std::size_t k = 0; k < power.size(); ++k)
    gain.push_back(power[k] > above * noise_power[k] ? 1.0 - noise_power[k] / power[k] : 0.0);
  // What is slower than a segment is not in its spectrum, and far above any noise.
  gain[0] = gain[1] = 1.0;
  return gain;
}

// The gain as a kernel in time, h[0] its middle, h[i] = h[-i], length / 2 values; tapered to its end.
std::vector<double> kernel_of(const std::vector<double>& gain) {
  const std::size_t half = gain.size() - 1;
  std::vector<double> h(half, 0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < half; ++i) {
    const double step = std::numbers::pi * static_cast<double>(i) / static_cast<double>(half);
    double value = 0.5 * (gain[0] + gain[half] * std::cos(step * static_cast<double>(half)));
    for (std::size_t k = 1; k < half; ++k) value += gain[k] * std::cos(step * static_cast<double>(k));
    h[i] = value / static_cast<double>(half) * 0.5 * (1.0 + std::cos(step));
    sum += i == 0 ? h[i] : 2.0 * h[i];
  }
  for (double& v : h) v /= sum;  // a constant stays what it is
  return h;
}

}  // namespace

WienerEstimate wiener_smoothed(std::span<const double> x, NoiseSpectrum noise) {
  const std::size_t n = x.size();
  WienerEstimate out;
  if (n < kLeastOfSpectrum) {
    out.value.assign(x.begin(), x.end());
    return out;
  }
  const Periodogram periodogram = periodogram_of(x, segment_length(n));
  const std::vector<double> noise_power = noise_of(periodogram, noise);
  const std::vector<double> gain = gain_of(periodogram, noise_power);
  for (std::size_t k = 0; k < gain.size(); ++k)
    out.error_spectrum.push_back(gain[k] * noise_power[k] / periodogram.window_square);
  auto last = static_cast<std::size_t>(
      kNoiseTo * static_cast<double>(gain.size() - 1));  // differences have no noise beyond
  while (last > 1 && gain[last] < 0.5) --last;
  out.resolved = static_cast<double>(last) / static_cast<double>(gain.size() - 1);
  const std::vector<double> h = kernel_of(gain);
  const std::size_t pad = h.size() - 1;
  // continued point-symmetrically at either end
  std::vector<double> y;
  y.reserve(n + 2 * pad);
  for (std::size_t i = pad; i > 0; --i) y.push_back(2.0 * x[0] - x[i]);
  y.insert(y.end(), x.begin(), x.end());
  for (std::size_t i = 1; i <= pad; ++i) y.push_back(2.0 * x[n - 1] - x[n - 1 - i]);
  out.value.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double* const middle = y.data() + k + pad;
    double value = h[0] * middle[0];
    for (std::size_t i = 1; i <= pad; ++i)
      value += h[i] * (middle[i] + middle[-static_cast<std::ptrdiff_t>(i)]);
    out.value[k] = value;
  }
  return out;
}

}  // namespace omnihil
