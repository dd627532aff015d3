#include "identify/estimate/fit.h"

#include <algorithm>
#include <cmath>

#include "identify/estimate/fit_descent.h"
#include "identify/estimate/fit_estimates.h"
#include "identify/estimate/fit_problem.h"
#include "identify/estimate/fit_profile.h"
#include "identify/estimate/fit_starts.h"

namespace omnihil {
namespace {

bool weights_moved(const std::map<std::string, SignalWeight>& a,
                   const std::map<std::string, SignalWeight>& b) {
  constexpr double kShare = 0.1;  // of a scale s_c; a choice, sensitivity not measured
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
  FitProblem problem(predictor, candidate, unknowns, options.jobs, options.robust, options.coarse);
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
  // The residuals are smaller now: weigh again and descend from there, three times at most (a choice).
  for (int pass = 0; pass < 3 && !stopped(); ++pass) {
    const auto before = problem.weights();
    if (!problem.reweigh(best.x) || !weights_moved(before, problem.weights())) break;
    Descent d = descend(problem, best.x, options.max_iterations, options);
    result.iterations += d.iterations;
    const FitPoint same = problem.at(best.x, false);
    if (d.cost <= same.cost()) best = std::move(d);
  }
  if (options.finish_undamped && !stopped()) best = finish_undamped(problem, std::move(best));
  // The result is never worse than the start. A model with an effect at neutral nests its parent there: its
  // noise cost must not rise either.
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
  if (options.profile && !result.stopped) profile(problem, best.x, options, result);
  return result;
}

}  // namespace omnihil
