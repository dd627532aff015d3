#include "identify/record/decimate.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace omnihil {

LowPass chebyshev(int order, double ripple_dB, double edge_Hz, double rate_Hz) {
  assert(order >= 2 && order % 2 == 0 && edge_Hz > 0.0 && edge_Hz < 0.5 * rate_Hz);
  const double w = std::tan(std::numbers::pi * edge_Hz / rate_Hz);
  const double eps = std::sqrt(std::pow(10.0, ripple_dB / 10.0) - 1.0);
  const double m = std::asinh(1.0 / eps) / order;
  LowPass filter{.sections = {}, .order = order};
  for (int k = 1; k <= order / 2; ++k) {
    const double angle = (2 * k - 1) * std::numbers::pi / (2.0 * order);
    const double re = std::sinh(m) * std::sin(angle) * w, im = std::cosh(m) * std::cos(angle) * w;
    // |p|^2 / (s^2 + 2 re s + |p|^2), s = (z - 1) / (z + 1)
    const double size = re * re + im * im, a0 = 1.0 + 2.0 * re + size;
    filter.sections.push_back(
        {size / a0, 2.0 * size / a0, size / a0, 2.0 * (size - 1.0) / a0, (1.0 - 2.0 * re + size) / a0});
  }
  const double gain = 1.0 / std::sqrt(1.0 + eps * eps);
  Biquad& first = filter.sections.front();
  first.b0 *= gain, first.b1 *= gain, first.b2 *= gain;
  return filter;
}

std::vector<double> decimate(std::span<const double> x, int factor) {
  // The filter of the usual tools' `decimate` (Chebyshev I of order 8, 0.05 dB, 0.8 of Nyquist), with which
  // the published force errors were computed (force_error.h).
  constexpr int kOrder = 8;                         // source: as above
  constexpr double kRipple_dB = 0.05, kEdge = 0.8;  // source: as above
  const std::vector<double> low = zero_phase(chebyshev(kOrder, kRipple_dB, kEdge * 0.5 / factor, 1.0), x);
  std::vector<double> out;
  for (std::size_t i = 0; i < low.size(); i += static_cast<std::size_t>(factor)) out.push_back(low[i]);
  return out;
}

}  // namespace omnihil
