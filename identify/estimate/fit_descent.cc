#include "identify/estimate/fit_descent.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>

#include "identify/estimate/fit_starts.h"
#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

Eigen::VectorXd scales_of(const FitProblem& problem) {
  Eigen::VectorXd scale(static_cast<Eigen::Index>(problem.unknowns().size()));
  for (Eigen::Index i = 0; i < scale.size(); ++i)
    scale[i] = problem.unknowns()[static_cast<std::size_t>(i)].scale;
  return scale;
}

// Ceres logs a start that cannot be evaluated to stderr, whatever its logging_type; the summary says it as well.
void silence_log() {
  static const bool kOnce = [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    return true;
  }();
  static_cast<void>(kOnce);
}

// Gauss-Newton matrix of data and priors, p x p, unknowns in units of their scale.
Eigen::MatrixXd curvature(const FitProblem& problem, const FitPoint& p, const Eigen::VectorXd& scale,
                          const Eigen::VectorXd& x) {
  Eigen::MatrixXd h = scale.asDiagonal() * p.information * scale.asDiagonal();
  for (Eigen::Index i = 0; i < scale.size(); ++i)
    h(i, i) += std::pow(scale[i] * prior_dz(problem.unknowns()[static_cast<std::size_t>(i)], x[i]), 2);
  return h;
}

// Removes one unknown from the normal equations h (p x p), g (p).
void hold(Eigen::MatrixXd& h, Eigen::VectorXd& g, Eigen::Index unknown) {
  g[unknown] = 0.0;
  h.row(unknown).setZero();
  h.col(unknown).setZero();
  h(unknown, unknown) = 1.0;
}

// Holds what is pressed against its bound, gradient g outwards: a Gauss-Newton step of all unknowns, clipped there, does not
// descend, one of the others does (Bertsekas, SIAM J. Control Optim. 20(2), 1982: two-metric projection).
void hold_at_bounds(const FitProblem& problem, const Eigen::VectorXd& x, Eigen::MatrixXd& h,
                    Eigen::VectorXd& g) {
  constexpr double kRounding =
      1e-12;  // of an unknown's scale: x has been divided and multiplied by it; a choice
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const Unknown& u = problem.unknowns()[static_cast<std::size_t>(i)];
    const double rounding = kRounding * u.scale;
    if ((x[i] <= u.lower + rounding && g[i] > 0.0) || (x[i] >= u.upper - rounding && g[i] < 0.0))
      hold(h, g, i);
  }
}

// The problem as Ceres sees it: as many residuals as unknowns and one more. With J'J + P = R'R and gradient
// g, the residuals R'^-1 g and sqrt(2 cost - |R'^-1 g|^2) have Jacobian [R; 0]: the same cost, gradient and
// Gauss-Newton matrix as a hundred thousand samples, which Ceres then need not hold. Unknowns are in units of
// their scale.
class Condensed : public ceres::CostFunction {
 public:
  Condensed(const FitProblem& problem, const Eigen::VectorXd& scale, Eigen::Index held)
      : problem_(problem), scale_(scale), held_(held) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(scale.size()));
    set_num_residuals(static_cast<int>(scale.size()) + 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index n = scale_.size();
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], n).cwiseProduct(scale_);
    Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
    const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    const FitPoint p = problem_.at(x, derivatives);
    if (!p.finite) return false;
    r.setZero();
    r[n] = std::sqrt(2.0 * p.cost());
    if (!derivatives) return true;
    Eigen::VectorXd g = scale_.cwiseProduct(p.gradient);
    Eigen::MatrixXd h = curvature(problem_, p, scale_, x);
    hold_at_bounds(problem_, x, h, g);
    if (held_ >= 0) hold(h, g, held_);
    // ridge, so that a direction with neither data nor prior leaves the matrix positive definite
    h.diagonal().array() += 1e-12 * std::max(h.diagonal().maxCoeff(), 1e-300);
    const Cholesky factor(h);
    if (!factor.positive_definite()) return false;
    Eigen::VectorXd head = factor.forward(g);
    const double rest = 2.0 * p.cost() - head.squaredNorm();
    if (rest < 0.0) head *= std::sqrt(2.0 * p.cost() / head.squaredNorm());  // rounding, at a cost near zero
    r.head(n) = head;
    r[n] = std::sqrt(std::max(0.0, rest));
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> j(jacobians[0], n + 1,
                                                                                         n);
    j.setZero();
    j.topRows(n) = factor.lower().transpose();
    return true;
  }

 private:
  const FitProblem& problem_;
  Eigen::VectorXd scale_;
  Eigen::Index held_;  // does not move; -1: none
};

// Gauss-Newton's step, size p, to be subtracted from x; an unknown pressed against its bound stays fixed.
Eigen::VectorXd full_step(const FitProblem& problem, const FitPoint& p, const Eigen::VectorXd& x,
                          const Eigen::VectorXd& scale) {
  Eigen::VectorXd g = scale.cwiseProduct(p.gradient);
  Eigen::MatrixXd h = curvature(problem, p, scale, x);
  hold_at_bounds(problem, x, h, g);
  h.diagonal().array() += 1e-12 * std::max(h.diagonal().maxCoeff(), 1e-300);
  return ldlt_solve(h, g).cwiseProduct(scale);
}

class Stopper : public ceres::IterationCallback {
 public:
  explicit Stopper(const std::function<bool()>& stop) : stop_(stop) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return stop_ && stop_() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<bool()>& stop_;
};

}  // namespace

Descent descend(const FitProblem& problem, const Eigen::VectorXd& start, int iterations,
                const FitOptions& options, Eigen::Index held) {
  const std::vector<Unknown>& unknowns = problem.unknowns();
  const Eigen::VectorXd scale = scales_of(problem);
  Eigen::VectorXd x = start.cwiseQuotient(scale);
  ceres::Problem ceres_problem;
  ceres_problem.AddResidualBlock(new Condensed(problem, scale, held), nullptr, x.data());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const auto at = static_cast<int>(i);
    ceres_problem.SetParameterLowerBound(x.data(), at, unknowns[i].lower / unknowns[i].scale);
    ceres_problem.SetParameterUpperBound(x.data(), at, unknowns[i].upper / unknowns[i].scale);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = iterations;
  // Relative; cost in a ranking needs to be known within what tells candidates apart (a per cent). Choices,
  // hundred times and more below that; Ceres' own defaults are 1e-6 and 1e-8. Sensitivity not measured.
  solver.function_tolerance = options.coarse ? 1e-4 : 1e-6;
  solver.parameter_tolerance = options.coarse ? 1e-5 : 1e-7;
  solver.initial_trust_region_radius = 1e3;  // damping 1e-3 of the curvature; Ceres' default is 1e4
  // With bounds each step is followed by a line search; by halves, or each trial would cost the derivatives
  // (DECISIONS 36: a fifth of the time, same optimum). Four halvings: a choice.
  solver.line_search_interpolation_type = ceres::BISECTION;
  solver.max_num_line_search_step_size_iterations = 4;
  solver.logging_type = ceres::SILENT;
  silence_log();
  solver.num_threads = 1;
  Stopper stopper(options.stop);
  solver.callbacks.push_back(&stopper);
  solver.update_state_every_iteration = true;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres_problem, &summary);
  Descent d;
  d.x = within_bounds(unknowns, x.cwiseProduct(scale));
  d.iterations = static_cast<int>(summary.iterations.size());
  d.converged = summary.termination_type == ceres::CONVERGENCE;
  const FitPoint p = problem.at(d.x, false);
  if (p.finite) d.cost = p.cost();
  return d;
}

Descent finish_undamped(const FitProblem& problem, Descent d) {
  constexpr int kMostSteps = 3;     // Gauss-Newton converges quadratically near the optimum; a choice
  constexpr int kMostHalvings = 4;  // down to 1/16 of a step; a choice
  const Eigen::VectorXd scale = scales_of(problem);
  for (int step = 0; step < kMostSteps; ++step) {
    const FitPoint p = problem.at(d.x, true);
    if (!p.finite) return d;
    d.cost = p.cost();  // with the current weights; d.cost was with the previous ones
    const double before = d.cost;
    const Eigen::VectorXd change = full_step(problem, p, d.x, scale);
    if (!change.allFinite()) return d;
    for (int half = 0; half <= kMostHalvings && d.cost == before; ++half) {
      const Eigen::VectorXd x = within_bounds(problem.unknowns(), d.x - std::ldexp(1.0, -half) * change);
      const FitPoint next = problem.at(x, false);
      if (!next.finite || next.cost() >= before) continue;
      d.x = x;
      d.cost = next.cost();
    }
    if (d.cost == before) return d;
  }
  return d;
}

}  // namespace omnihil
