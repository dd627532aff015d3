#include "sim/identify/fit.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sim/identify/fit_estimates.h"
#include "sim/identify/fit_problem.h"
#include "sim/identify/fit_starts.h"

namespace omnihil {
namespace {

// The problem as Ceres sees it: as many residuals as unknowns and one more. With J'J + P = R'R and gradient
// g, the residuals R'^-1 g and sqrt(2 cost - |R'^-1 g|^2) have Jacobian [R; 0]: the same cost, gradient and
// Gauss-Newton matrix as a hundred thousand samples, which Ceres then need not hold. Unknowns are in units of
// their scale.
class Condensed : public ceres::CostFunction {
 public:
  Condensed(const FitProblem& problem, const Eigen::VectorXd& scale) : problem_(problem), scale_(scale) {
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
    const Eigen::VectorXd g = scale_.cwiseProduct(p.gradient);
    Eigen::MatrixXd h = scale_.asDiagonal() * p.information * scale_.asDiagonal();
    for (Eigen::Index i = 0; i < n; ++i) {
      const double prior = problem_.unknowns()[static_cast<std::size_t>(i)].prior_sigma;
      if (prior > 0.0) h(i, i) += scale_[i] * scale_[i] / (prior * prior);
    }
    // a direction of which nobody knows anything must not stop the rest
    h.diagonal().array() += 1e-12 * std::max(h.diagonal().maxCoeff(), 1e-300);
    const Eigen::LLT<Eigen::MatrixXd> llt(h);
    if (llt.info() != Eigen::Success) return false;
    const Eigen::MatrixXd upper = llt.matrixU();
    Eigen::VectorXd head = llt.matrixL().solve(g);
    const double rest = 2.0 * p.cost() - head.squaredNorm();
    if (rest < 0.0) head *= std::sqrt(2.0 * p.cost() / head.squaredNorm());  // rounding, at a cost near zero
    r.head(n) = head;
    r[n] = std::sqrt(std::max(0.0, rest));
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> j(jacobians[0], n + 1,
                                                                                         n);
    j.setZero();
    j.topRows(n) = upper;
    return true;
  }

 private:
  const FitProblem& problem_;
  Eigen::VectorXd scale_;
};

class Stopper : public ceres::IterationCallback {
 public:
  explicit Stopper(const std::function<bool()>& stop) : stop_(stop) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return stop_ && stop_() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<bool()>& stop_;
};

struct Descent {
  Eigen::VectorXd x;
  double cost = INFINITY;
  int iterations = 0;
  bool converged = false;
};

Descent descend(const FitProblem& problem, const Eigen::VectorXd& start, int iterations,
                const FitOptions& options) {
  const std::vector<Unknown>& unknowns = problem.unknowns();
  Eigen::VectorXd scale(start.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) scale[static_cast<Eigen::Index>(i)] = unknowns[i].scale;
  Eigen::VectorXd x = start.cwiseQuotient(scale);
  ceres::Problem ceres_problem;
  ceres_problem.AddResidualBlock(new Condensed(problem, scale), nullptr, x.data());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const auto at = static_cast<int>(i);
    ceres_problem.SetParameterLowerBound(x.data(), at, unknowns[i].lower / unknowns[i].scale);
    ceres_problem.SetParameterUpperBound(x.data(), at, unknowns[i].upper / unknowns[i].scale);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = iterations;
  solver.function_tolerance = options.quick ? 1e-4 : 1e-6;
  solver.parameter_tolerance = options.quick ? 1e-5 : 1e-7;
  solver.initial_trust_region_radius = 1e3;
  solver.logging_type = ceres::SILENT;
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

bool weights_moved(const std::map<std::string, SignalWeight>& a,
                   const std::map<std::string, SignalWeight>& b) {
  constexpr double kShare = 0.1;
  for (const auto& [name, w] : a) {
    const auto other = b.find(name);
    if (other == b.end() || std::abs(other->second.size - w.size) > kShare * w.size) return true;
  }
  return false;
}

}  // namespace

FitResult fit(const Predictor& predictor, const Candidate& candidate, const std::vector<Unknown>& unknowns,
              const FitOptions& options) {
  FitResult result;
  result.unknowns = unknowns;
  result.model = candidate;
  FitProblem problem(predictor, candidate, unknowns, options.jobs);
  Eigen::VectorXd given(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t i = 0; i < unknowns.size(); ++i) given[static_cast<Eigen::Index>(i)] = unknowns[i].start;
  given = within_bounds(unknowns, given);
  if (problem.empty() || !problem.reweigh(given)) {
    result.findings.push_back(problem.empty() ? "no run of use \"fit\" can be compared"
                                              : "the model is not finite at the start of the fit");
    return result;
  }
  if (unknowns.empty()) {
    result.cost = problem.at(given, false).cost();
    result.data_cost = problem.noise_cost(given);
    result.converged = true;
    return result;
  }
  const auto stopped = [&] { return options.stop && options.stop(); };
  Descent best;
  for (const Eigen::VectorXd& start : fit_starts(problem, given, options.starts, options.seed)) {
    Descent d = descend(problem, start, options.max_iterations, options);
    result.iterations += d.iterations;
    if (d.cost < best.cost || best.x.size() == 0) best = std::move(d);
    if (stopped()) break;
  }
  // The residuals are smaller now: weigh again, and go on from there.
  for (int pass = 0; pass < 3 && !stopped(); ++pass) {
    const auto before = problem.weights();
    if (!problem.reweigh(best.x) || !weights_moved(before, problem.weights())) break;
    Descent d = descend(problem, best.x, options.max_iterations, options);
    result.iterations += d.iterations;
    const FitPoint same = problem.at(best.x, false);
    if (d.cost <= same.cost()) best = std::move(d);
  }
  // Never above where it started; a model whose effects start at neutral is its parent there.
  const FitPoint start = problem.at(given, false), end = problem.at(best.x, false);
  const bool nested = std::any_of(candidate.effects.begin(), candidate.effects.end(), is_neutral);
  const bool above = nested && problem.noise_cost(best.x) > problem.noise_cost(given);
  if (start.finite && (above || !(end.cost() <= start.cost()))) best.x = given;
  result.stopped = stopped();
  result.converged = best.converged;
  const FitPoint point = problem.at(best.x, true);
  result.model = problem.candidate_at(best.x);
  result.cost = 2.0 * point.cost();
  result.data_cost = problem.noise_cost(best.x);
  describe(problem, predictor, point, best.x, result);
  return result;
}

}  // namespace omnihil
