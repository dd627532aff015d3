#include "hil/report/report_orders.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "identify/record/statistics.h"

namespace omnihil {
namespace {

constexpr double kPi = std::numbers::pi;

struct Sample {
  double angle_rad;
  double step_rad;
  double residual;
};

std::vector<Sample> usable(std::span<const double> angle_rad, std::span<const double> residual) {
  std::vector<Sample> samples;
  for (std::size_t i = 1; i < std::min(angle_rad.size(), residual.size()); ++i) {
    const double step_rad = std::fabs(std::remainder(angle_rad[i] - angle_rad[i - 1], 2.0 * kPi));
    if (std::isfinite(step_rad) && step_rad > 0.0 && std::isfinite(residual[i])) {
      samples.push_back({angle_rad[i], step_rad, residual[i]});
    }
  }
  double sum = 0.0, weight = 0.0;
  for (const Sample& s : samples) {
    sum += s.step_rad * s.residual;
    weight += s.step_rad;
  }
  for (Sample& s : samples) s.residual -= sum / weight;
  return samples;
}

}  // namespace

OrderSums order_sums(std::span<const double> angle_rad, std::span<const double> residual,
                     std::size_t orders) {
  OrderSums sums{0.0, std::vector<double>(orders, 0.0), std::vector<double>(orders, 0.0)};
  std::vector<std::complex<double>> amplitude(orders, 0.0);
  for (const Sample& s : usable(angle_rad, residual)) {
    sums.turns += s.step_rad / (2.0 * kPi);
    const std::size_t reach = std::min(orders, static_cast<std::size_t>(kPi / s.step_rad));
    const std::complex<double> turn = std::polar(1.0, -s.angle_rad);
    std::complex<double> wave = turn;
    for (std::size_t n = 0; n < reach; ++n, wave *= turn) {
      amplitude[n] += s.step_rad * s.residual * wave;
      sums.weight[n] += s.step_rad;
    }
  }
  // amplitude[n] is A_n weight / 2
  for (std::size_t n = 0; n < orders; ++n) {
    if (sums.weight[n] > 0.0) sums.power[n] = 4.0 * std::norm(amplitude[n]) / sums.weight[n];
  }
  return sums;
}

double order_floor(const std::vector<double>& amplitude) { return 3.0 * median(amplitude); }

}  // namespace omnihil
