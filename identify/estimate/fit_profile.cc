#include "identify/estimate/fit_profile.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr int kMost = 4;        // unknowns profiled: two refits each; bounds the cost, a choice
constexpr int kIterations = 4;  // of each refit; a choice, convergence not checked
constexpr double kFlat = 0.1;   // squared sigmas where 1 is expected: three times the sigma or more; a choice

// Twice the rise of the cost with unknown i held at `value`; infinite where the model is not finite there.
double rise(const FitProblem& problem, const Eigen::VectorXd& x, double cost, Eigen::Index i, double value,
            const FitOptions& options) {
  Eigen::VectorXd start = x;
  start[i] = value;
  const Descent d = descend(problem, start, kIterations, options, i);
  return std::max(0.0, 2.0 * (d.cost - cost));
}

}  // namespace

void profile(const FitProblem& problem, const Eigen::VectorXd& x, const FitOptions& options,
             FitResult& result) {
  std::vector<std::pair<double, std::size_t>> doubtful;
  for (std::size_t n = 0; n < result.parameters.size(); ++n) {
    const ParameterEstimate& p = result.parameters[n];
    const double known = p.prior_sigma > 0.0 ? p.sigma / p.prior_sigma : (p.identifiable ? 0.0 : 1.0);
    // the prior gives 9 % of the information or more (0.3^2); a choice
    if (p.at_bound || known > 0.3) doubtful.emplace_back(-known, n);
  }
  std::sort(doubtful.begin(), doubtful.end());
  const double cost = problem.at(x, false).cost();
  for (std::size_t d = 0; d < doubtful.size() && d < kMost; ++d) {
    if (options.stop && options.stop()) return;
    ParameterEstimate& p = result.parameters[doubtful[d].second];
    const Unknown& u = problem.unknowns()[doubtful[d].second];
    const auto i = static_cast<Eigen::Index>(doubtful[d].second);
    double sum = 0.0, sides = 0.0;
    for (const double side : {-1.0, 1.0}) {
      const double value = std::clamp(x[i] + side * p.sigma, u.lower, u.upper);
      const double displacement = std::abs(value - x[i]);
      if (!(displacement > 0.1 * p.sigma)) continue;  // at the bound: no room on this side
      const double squared = rise(problem, x, cost, i, value, options);
      if (!std::isfinite(squared)) continue;
      sum += squared / (displacement * displacement), sides += 1.0;
    }
    if (sides == 0.0) continue;
    const double curvature = sum / sides;
    if (curvature * p.sigma * p.sigma < kFlat) {
      p.identifiable = false;
      if (p.sentence.empty()) p.sentence = "not determined by these data";
    } else {
      p.sigma = 1.0 / std::sqrt(curvature);
    }
  }
}

}  // namespace omnihil
