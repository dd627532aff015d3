#include "identify/estimate/fit_profile.h"

#include <algorithm>
#include <cmath>

#include "identify/record/parallel.h"

namespace omnihil {
namespace {

constexpr int kMost = 4;        // unknowns profiled: two refits each; bounds the cost, a choice
constexpr int kIterations = 4;  // of each refit; a choice, convergence not checked
constexpr double kFlat = 0.1;   // squared sigmas where 1 is expected: three times the sigma or more; a choice

// One side of one unknown: where it is held.
struct Held {
  std::size_t unknown = 0;
  double value = 0.0, displacement = 0.0;
};

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
  if (doubtful.size() > kMost) doubtful.resize(kMost);
  std::vector<Held> held;
  for (const auto& [known, n] : doubtful) {
    const double sigma = result.parameters[n].sigma;
    const Unknown& u = problem.unknowns()[n];
    const double from = x[static_cast<Eigen::Index>(n)];
    for (const double side : {-1.0, 1.0}) {
      const double value = std::clamp(from + side * sigma, u.lower, u.upper);
      const double displacement = std::abs(value - from);
      if (displacement > 0.1 * sigma) held.push_back({n, value, displacement});  // else at the bound: no room
    }
  }
  const double cost = problem.at(x, false).cost();
  std::vector<double> rises(held.size());
  parallel_for(options.jobs, static_cast<int>(held.size()), [&](int k) {
    const Held& h = held[static_cast<std::size_t>(k)];
    const std::unique_ptr<FitProblem> own = problem.beside();
    rises[static_cast<std::size_t>(k)] =
        rise(*own, x, cost, static_cast<Eigen::Index>(h.unknown), h.value, options);
  });
  if (options.stop && options.stop()) return;
  for (const auto& [known, n] : doubtful) {
    ParameterEstimate& p = result.parameters[n];
    double sum = 0.0, sides = 0.0;
    for (std::size_t k = 0; k < held.size(); ++k) {
      if (held[k].unknown != n || !std::isfinite(rises[k])) continue;
      sum += rises[k] / (held[k].displacement * held[k].displacement), sides += 1.0;
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
