#include "identify/predict/predictor.h"

#include <cmath>

#include "identify/record/rig.h"

namespace omnihil {

void whiten(const ComparedSignal& signal, Eigen::Ref<Eigen::MatrixXd> columns) {
  if (signal.whitening_s <= 0.0) return;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    double y = 0.0;
    double last_s = 0.0;
    bool started = false;
    for (Eigen::Index k = 0; k < columns.rows(); ++k) {
      double& r = columns(k, c);
      const double now_s = signal.time_s[static_cast<std::size_t>(k)];
      if (!std::isfinite(r)) {
        if (!started) last_s = now_s;
        continue;
      }
      const double dt = k > 0 ? now_s - last_s : 0.0;
      // y_i = exp(-dt / tau) y_{i-1} + r_i dt
      y = std::exp(-dt / signal.whitening_s) * y + r * dt;
      last_s = now_s;
      started = true;
      r = y;
    }
  }
}

std::vector<double> whitened(const ComparedSignal& signal, std::vector<double> residual) {
  Eigen::Map<Eigen::MatrixXd> column(residual.data(), static_cast<Eigen::Index>(residual.size()), 1);
  whiten(signal, column);
  return residual;
}

void average(const ComparedSignal& signal, Eigen::Ref<Eigen::MatrixXd> columns) {
  if (signal.averaging_s <= 0.0) return;
  const auto dt = [&](Eigen::Index k) {
    const auto at = static_cast<std::size_t>(k);
    return k > 0 ? signal.time_s[at] - signal.time_s[at - 1] : 0.0;
  };
  constexpr double kRounding = 1e-6;  // of a period: time stamps are sums; a choice
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const Eigen::VectorXd rate = columns.col(c);
    const auto displacement = [&](Eigen::Index k) { return std::isfinite(rate[k]) ? rate[k] * dt(k) : 0.0; };
    double sum = 0.0;
    Eigen::Index first = 0;  // of the window
    for (Eigen::Index k = 0; k < columns.rows(); ++k) {
      sum += displacement(k);
      const double from_s =
          signal.time_s[static_cast<std::size_t>(k)] - signal.averaging_s + kRounding * dt(k);
      for (; signal.time_s[static_cast<std::size_t>(first)] < from_s; ++first) sum -= displacement(first);
      if (std::isfinite(rate[k])) columns(k, c) = sum / signal.averaging_s;
    }
  }
}

std::vector<double> averaged(const ComparedSignal& signal, std::vector<double> residual) {
  Eigen::Map<Eigen::MatrixXd> column(residual.data(), static_cast<Eigen::Index>(residual.size()), 1);
  average(signal, column);
  return residual;
}

double averaged_sigma(const ComparedSignal& signal) {
  if (signal.averaging_s <= 0.0 || signal.time_s.size() < 2) return signal.noise_sigma;
  const double period_s =
      (signal.time_s.back() - signal.time_s.front()) / static_cast<double>(signal.time_s.size() - 1);
  return signal.noise_sigma * period_s / signal.averaging_s;  // both are sqrt(2) position noise / time
}

std::unique_ptr<Predictor> make_predictor(const Dataset& dataset, const Candidate& nominal,
                                          const PredictOptions& options) {
  return dataset.rig->make_predictor(dataset, nominal, options);
}

}  // namespace omnihil
