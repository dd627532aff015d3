#include "identify/record/filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

namespace omnihil {
namespace {

// Filters x by one section in place, from the section's steady state for the constant input x[0].
void run(const Biquad& s, std::vector<double>& x) {
  const double gain = (s.b0 + s.b1 + s.b2) / (1.0 + s.a1 + s.a2);
  const double first = x.front();
  // transposed direct form II, settled: y = gain x, z2 = b2 x - a2 y, z1 = b1 x - a1 y + z2
  double z2 = s.b2 * first - s.a2 * gain * first;
  double z1 = s.b1 * first - s.a1 * gain * first + z2;
  for (double& v : x) {
    const double y = s.b0 * v + z1;
    z1 = s.b1 * v - s.a1 * y + z2;
    z2 = s.b2 * v - s.a2 * y;
    v = y;
  }
}

}  // namespace

LowPass butterworth(int order, double cutoff_Hz, double rate_Hz) {
  assert(order >= 1 && cutoff_Hz > 0.0 && cutoff_Hz < 0.5 * rate_Hz);
  // s = (2/T) (z - 1)/(z + 1), scaled so that the cutoff is at w = tan(pi fc / fs)
  const double w = std::tan(std::numbers::pi * cutoff_Hz / rate_Hz);
  LowPass filter{.sections = {}, .order = order};
  for (int k = 0; k < order / 2; ++k) {
    // poles w exp(i (pi/2 + (2k+1) pi / 2n)): s^2 + 2 sin((2k+1) pi / 2n) w s + w^2
    const double q = 2.0 * std::sin((2 * k + 1) * std::numbers::pi / (2.0 * order));
    const double a0 = 1.0 + q * w + w * w;
    filter.sections.push_back(
        {w * w / a0, 2.0 * w * w / a0, w * w / a0, 2.0 * (w * w - 1.0) / a0, (1.0 - q * w + w * w) / a0});
  }
  if (order % 2 == 1) {
    const double a0 = 1.0 + w;
    filter.sections.push_back({w / a0, w / a0, 0.0, (w - 1.0) / a0, 0.0});
  }
  return filter;
}

double zero_phase_gain(const LowPass& filter, double share_of_nyquist) {
  const std::complex<double> back = std::polar(1.0, -std::numbers::pi * share_of_nyquist);  // 1 / z
  double square = 1.0;
  for (const Biquad& s : filter.sections)
    square *= std::norm((s.b0 + back * (s.b1 + back * s.b2)) / (1.0 + back * (s.a1 + back * s.a2)));
  return square;
}

std::vector<double> zero_phase(const LowPass& filter, std::span<const double> x) {
  const std::size_t n = x.size();
  if (n < 2) return {x.begin(), x.end()};
  const std::size_t pad = std::min<std::size_t>(3 * static_cast<std::size_t>(filter.order + 1), n - 1);
  std::vector<double> y;
  y.reserve(n + 2 * pad);
  for (std::size_t i = pad; i > 0; --i) y.push_back(2.0 * x[0] - x[i]);
  y.insert(y.end(), x.begin(), x.end());
  for (std::size_t i = 1; i <= pad; ++i) y.push_back(2.0 * x[n - 1] - x[n - 1 - i]);
  for (int pass = 0; pass < 2; ++pass) {
    for (const Biquad& section : filter.sections) run(section, y);
    std::reverse(y.begin(), y.end());
  }
  return {y.begin() + static_cast<std::ptrdiff_t>(pad), y.begin() + static_cast<std::ptrdiff_t>(pad + n)};
}

Eigen::MatrixXd zero_phase(const LowPass& filter, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd out(columns.rows(), columns.cols());
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const std::vector<double> y = zero_phase(
        filter, std::span<const double>(columns.col(c).data(), static_cast<std::size_t>(columns.rows())));
    out.col(c) = Eigen::Map<const Eigen::VectorXd>(y.data(), columns.rows());
  }
  return out;
}

std::vector<double> central_differences(std::span<const double> x) {
  const std::size_t n = x.size();
  std::vector<double> d(n, 0.0);
  if (n < 2) return d;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    d[i] = 0.5 * (x[i + 1] - x[i - 1]);
    // -x'''/6 of it, by the samples beyond
    if (i > 1 && i + 2 < n) d[i] += (2.0 * (x[i + 1] - x[i - 1]) - (x[i + 2] - x[i - 2])) / 12.0;
  }
  d[0] = x[1] - x[0];
  d[n - 1] = x[n - 1] - x[n - 2];
  return d;
}

}  // namespace omnihil
