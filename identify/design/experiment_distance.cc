#include "identify/design/experiment_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

struct Normal {
  double square = 0.0;
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;  // J' r
  bool finite = true;
};

// Normal equations of n samples and p unknowns: J'J (p x p), J'r (p).
// add: one signal's part; `residual` [n x 1] and `columns` [n x p] are NaN where nothing is measured.
void add(const ComparedSignal& signal, double variance, Eigen::MatrixXd residual, Eigen::MatrixXd columns,
         Normal& sum) {
  whiten(signal, residual);
  whiten(signal, columns);
  for (Eigen::Index k = 0; k < residual.rows(); ++k) {
    if (std::isfinite(residual(k, 0))) continue;
    residual(k, 0) = 0.0;
    columns.row(k).setZero();
  }
  sum.square += residual.squaredNorm() / variance;
  sum.gradient += columns.transpose() * residual.col(0) / variance;
  sum.information += columns.transpose() * columns / variance;
}

double variance_of(const SignalVariances& variances, const ComparedSignal& signal) {
  const auto found = variances.find(signal.name);
  const double own = signal.whitened_sigma > 0.0 ? signal.whitened_sigma : signal.noise_sigma;
  const double floor = std::max(own * own, 1e-300);
  return found != variances.end() ? std::max(found->second, floor) : floor;
}

// The rival at x (size p) against the truth's predictions, one per run.
Normal normal_at(const Predictor& simulated, const std::vector<int>& runs,
                 const std::vector<Prediction>& truth, const HeldModel& rival, const Eigen::VectorXd& x,
                 const SignalVariances& variances) {
  const auto n = static_cast<Eigen::Index>(rival.unknowns.size());
  Normal sum{.information = Eigen::MatrixXd::Zero(n, n), .gradient = Eigen::VectorXd::Zero(n)};
  const Candidate here = with_values(rival.model, rival.unknowns, {x.data(), static_cast<std::size_t>(n)});
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Prediction y = simulated.predict_with_derivatives(here, rival.unknowns, runs[i]);
    sum.finite = sum.finite && y.finite && truth[i].finite;
    const std::vector<ComparedSignal>& compared = simulated.compared(runs[i]);
    for (std::size_t s = 0; s < compared.size(); ++s) {
      const auto rows = static_cast<Eigen::Index>(compared[s].measured.size());
      Eigen::MatrixXd residual(rows, 1);
      Eigen::MatrixXd columns = n > 0 ? y.derivatives[s] : Eigen::MatrixXd(rows, 0);
      for (Eigen::Index k = 0; k < rows; ++k) {
        const auto at = static_cast<std::size_t>(k);
        residual(k, 0) = truth[i].values[s][at] - y.values[s][at];
        if (!std::isfinite(compared[s].measured[at])) residual(k, 0) = std::nan("");
        if (!std::isfinite(residual(k, 0))) columns.row(k).setConstant(std::nan(""));
      }
      add(compared[s], variance_of(variances, compared[s]), std::move(residual), std::move(columns), sum);
    }
  }
  return sum;
}

// Solves A d = b, A p x p symmetric and badly scaled: diagonal scaling to ones, ridge 1e-12 of it.
Eigen::VectorXd solve_scaled(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd scale = a.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd even = scale.asDiagonal() * a * scale.asDiagonal();
  even.diagonal().array() += 1e-12;
  return scale.asDiagonal() * ldlt_solve(even, scale.asDiagonal() * b);
}

}  // namespace

Eigen::MatrixXd prior_hold(const std::vector<Unknown>& unknowns) {
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Eigen::MatrixXd hold = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double sigma = unknowns[static_cast<std::size_t>(i)].prior_sigma;
    if (sigma > 0.0) hold(i, i) = 1.0 / (sigma * sigma);
  }
  return hold;
}

Distance refitted_distance(const Predictor& simulated, const std::vector<int>& runs, const Candidate& truth,
                           const HeldModel& rival, const SignalVariances& variances, int iterations) {
  std::vector<Prediction> predictions;
  for (const int run : runs) predictions.push_back(simulated.predict(truth, run));
  Eigen::VectorXd x = rival.center;
  Distance out;
  double best = std::numeric_limits<double>::infinity();
  for (int iteration = 0;; ++iteration) {
    const Normal now = normal_at(simulated, runs, predictions, rival, x, variances);
    const Eigen::VectorXd moved = x - rival.center;
    const double held = moved.dot(rival.hold * moved);
    if (iteration == 0) out.finite = now.finite;
    if (!now.finite || !std::isfinite(now.square)) break;
    best = std::min(best, now.square + held);
    if (x.size() == 0 || (iteration == iterations && iterations > 0)) break;
    const Eigen::MatrixXd all = now.information + rival.hold;
    const Eigen::VectorXd gradient = now.gradient - rival.hold * moved;
    const Eigen::VectorXd step = solve_scaled(all, gradient);
    if (iterations == 0) {
      best = std::max(0.0, now.square + held - gradient.dot(step));
      break;
    }
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Unknown& u = rival.unknowns[static_cast<std::size_t>(i)];
      x(i) = std::clamp(x(i) + step(i), u.lower, u.upper);
    }
  }
  out.sigmas = std::isfinite(best) ? std::sqrt(best) : 0.0;
  return out;
}

Eigen::MatrixXd information_of(const Predictor& simulated, const std::vector<int>& runs,
                               const HeldModel& model, const SignalVariances& variances) {
  std::vector<Prediction> predictions;
  for (const int run : runs) predictions.push_back(simulated.predict(model.model, run));
  return normal_at(simulated, runs, predictions, model, model.center, variances).information;
}

double sigma_of(const Eigen::MatrixXd& information, Eigen::Index unknown) {
  Eigen::VectorXd one = Eigen::VectorXd::Zero(information.rows());
  one(unknown) = 1.0;
  const double variance = solve_scaled(information, one)(unknown);
  return variance > 0.0 ? std::sqrt(variance) : std::numeric_limits<double>::infinity();
}

}  // namespace omnihil
