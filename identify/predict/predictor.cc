#include "identify/predict/predictor.h"

#include <cmath>

#include "identify/predict/predictor_axis.h"
#include "identify/predict/predictor_robot.h"

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

std::unique_ptr<Predictor> make_predictor(const Dataset& dataset, const Candidate& nominal,
                                          const PredictOptions& options) {
  return dataset.rig == Rig::kAxis ? make_axis_predictor(dataset, nominal, options)
                                   : make_robot_predictor(dataset, nominal, options);
}

}  // namespace omnihil
