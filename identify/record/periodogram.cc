#include "identify/record/periodogram.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "identify/record/statistics.h"

namespace omnihil {
namespace {

constexpr std::size_t kShortest = 32, kLongest = 1024;  // by cost

using Spectrum = std::vector<std::complex<double>>;

// Calls `each(spectrum)` of every windowed segment of x; the sum of the windows' squares.
template <typename Each>
double for_each_segment(std::span<const double> x, std::size_t length, Each each) {
  Eigen::FFT<double> fft;
  std::vector<double> segment(length);
  Spectrum spectrum;
  double square = 0.0;
  for (std::size_t from = 0; from + length <= x.size(); from += length / 2) {
    double mean = 0.0;
    for (std::size_t i = 0; i < length; ++i) mean += x[from + i] / static_cast<double>(length);
    for (std::size_t i = 0; i < length; ++i) {
      const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length);
      const double window = 0.5 * (1.0 - std::cos(turn));
      segment[i] = window * (x[from + i] - mean);
      square += window * window;
    }
    fft.fwd(spectrum, segment);
    each(spectrum);
  }
  return square;
}

}  // namespace

std::size_t segment_length(std::size_t samples) {
  std::size_t length = kShortest;
  while (length < kLongest && 2 * length * 8 <= samples) length *= 2;
  return length;
}

Periodogram periodogram_of(std::span<const double> x, std::size_t length) {
  Periodogram out{.power = std::vector<double>(length / 2 + 1, 0.0)};
  out.window_square = for_each_segment(x, length, [&](const Spectrum& s) {
    for (std::size_t k = 0; k < out.power.size(); ++k) out.power[k] += std::norm(s[k]);
    out.segments += 1.0;
  });
  return out;
}

// (1 - 2 / (9 n))^3 (Wilson, Hilferty 1931); n degrees from the relative deviation.
double median_over_mean(double segments) {
  const double degrees = 2.0 * segments / (kWelchDeviation * kWelchDeviation);
  return std::pow(1.0 - 2.0 / (9.0 * degrees), 3);
}

double incoherent_sigma(std::span<const double> x, std::span<const double> y, double band) {
  if (x.size() < kLeastOfSpectrum || y.size() != x.size()) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t length = segment_length(x.size());
  std::vector<Spectrum> of_x;
  const double window_square = for_each_segment(x, length, [&](const Spectrum& s) { of_x.push_back(s); });
  Spectrum cross(length / 2 + 1);
  std::vector<double> x_power(cross.size(), 0.0), y_power(cross.size(), 0.0);
  std::size_t n = 0;
  for_each_segment(y, length, [&](const Spectrum& s) {
    for (std::size_t k = 0; k < cross.size(); ++k) {
      cross[k] += of_x[n][k] * std::conj(s[k]);
      x_power[k] += std::norm(of_x[n][k]);
      y_power[k] += std::norm(s[k]);
    }
    ++n;
  });
  const double independent = static_cast<double>(n) / (kWelchDeviation * kWelchDeviation);
  std::vector<double> left;
  for (std::size_t k = 0; k < cross.size(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(cross.size() - 1);
    if (share < band || share > kNoiseTo) continue;
    const double explained = y_power[k] > 0.0 ? std::norm(cross[k]) / y_power[k] : 0.0;
    left.push_back(std::max(0.0, x_power[k] - explained) / (1.0 - 1.0 / independent));
  }
  if (left.empty()) return std::numeric_limits<double>::quiet_NaN();
  // one segment less: a complex coefficient a frequency is fitted
  const double power = median(std::move(left)) / median_over_mean(static_cast<double>(n) - 1.0);
  return power > 0.0 ? std::sqrt(power / window_square) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace omnihil
