#include "identify/estimate/fit_starts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "sim/law/random.h"

namespace omnihil {
namespace {

struct EffectPlaces {  // indices into the unknowns
  std::vector<Eigen::Index> strengths, phases, shapes;
};

// Neutral value of an unknown that is a strength or a detail; empty prior mean otherwise.
bool is_strength(const Candidate& c, const Unknown& u) {
  const EffectUse& use = c.effects[static_cast<std::size_t>(u.effect)];
  return use.entry->info->params[static_cast<std::size_t>(u.row)].role != ParamRole::kShape;
}
double neutral_of(const Candidate& c, const Unknown& u) {
  const EffectUse& use = c.effects[static_cast<std::size_t>(u.effect)];
  return use.entry->info->params[static_cast<std::size_t>(u.row)].neutral;
}

std::map<int, EffectPlaces> effects_at_neutral(const FitProblem& problem, const Candidate& c,
                                               const Eigen::VectorXd& x) {
  std::map<int, EffectPlaces> out;
  std::map<int, bool> neutral;
  for (std::size_t n = 0; n < problem.unknowns().size(); ++n) {
    const Unknown& u = problem.unknowns()[n];
    const auto i = static_cast<Eigen::Index>(n);
    if (u.effect < 0) continue;
    EffectPlaces& places = out[u.effect];
    if (is_strength(c, u)) {
      places.strengths.push_back(i);
      const bool same = x[i] == neutral_of(c, u);
      neutral[u.effect] = same && (neutral.contains(u.effect) ? neutral[u.effect] : true);
    } else if (u.trait == ParamTrait::kPeriodic) {
      places.phases.push_back(i);
    } else {
      places.shapes.push_back(i);
    }
  }
  std::erase_if(out, [&](const auto& e) { return e.second.strengths.empty() || !neutral[e.first]; });
  return out;
}

// Reduction of the cost by one strength alone, and its Gauss-Newton step.
struct Slope {
  double gain = 0.0;
  double step = 0.0;
  double gradient = 0.0;
};
Slope slope_at(const FitProblem& problem, const Eigen::VectorXd& x, Eigen::Index strength) {
  const FitPoint p = problem.along(x, strength);
  Slope s;
  if (!p.finite) return s;
  const Unknown& u = problem.unknowns()[static_cast<std::size_t>(strength)];
  const double curvature = p.information(0, 0) + std::pow(prior_dz(u, x[strength]), 2);
  s.gradient = p.gradient[0];
  if (!(curvature > 0.0)) return s;
  s.step = -s.gradient / curvature;
  const double end = std::clamp(x[strength] + s.step, u.lower, u.upper) - x[strength];
  s.step = end;
  s.gain = -(s.gradient * end + 0.5 * curvature * end * end);
  return s;
}

void choose_phases(const FitProblem& problem, const EffectPlaces& places, Eigen::VectorXd& x) {
  // A sin(n theta + p) = A cos p sin + A sin p cos: the gradients at 0 and pi/2 are the two components
  for (const Eigen::Index phase : places.phases) {
    const Eigen::Index strength = places.strengths.front();
    Eigen::VectorXd at = x;
    at[phase] = 0.0;
    const double sine = slope_at(problem, at, strength).gradient;
    at[phase] = 0.5 * std::numbers::pi;
    const double cosine = slope_at(problem, at, strength).gradient;
    if (sine != 0.0 || cosine != 0.0) x[phase] = std::atan2(-cosine, -sine);
  }
}

void choose_shapes(const FitProblem& problem, const EffectPlaces& places, Eigen::VectorXd& x) {
  constexpr double kFactors[] = {0.2, 1.0, 5.0};  // of a typical shape: a decade and a half; a choice
  for (const Eigen::Index shape : places.shapes) {
    Eigen::VectorXd best = x;
    double best_gain = -1.0;
    for (const double factor : kFactors) {
      Eigen::VectorXd at = x;
      at[shape] *= factor;
      at = within_bounds(problem.unknowns(), at);
      const double gain = slope_at(problem, at, places.strengths.front()).gain;
      if (gain > best_gain) best = at, best_gain = gain;
    }
    x = best;
  }
}

void choose_strengths(const FitProblem& problem, const EffectPlaces& places, Eigen::VectorXd& x) {
  for (const Eigen::Index strength : places.strengths) {
    const Unknown& u = problem.unknowns()[static_cast<std::size_t>(strength)];
    const double neutral = x[strength];
    std::vector<double> sizes = {neutral + slope_at(problem, x, strength).step};
    for (const double share : {0.1, 0.3, 1.0}) {  // of its typical size; a choice
      sizes.push_back(neutral + share * u.scale);
      if (u.lower < neutral) sizes.push_back(neutral - share * u.scale);
    }
    double best_cost = INFINITY, best = neutral;
    for (const double size : sizes) {
      if (size == neutral) continue;
      Eigen::VectorXd at = x;
      at[strength] = std::clamp(size, u.lower, u.upper);
      const FitPoint p = problem.at(at, false);
      if (p.finite && p.cost() < best_cost) best_cost = p.cost(), best = at[strength];
    }
    x[strength] = best;
  }
}

}  // namespace

Eigen::VectorXd within_bounds(const std::vector<Unknown>& unknowns, Eigen::VectorXd x) {
  for (std::size_t n = 0; n < unknowns.size(); ++n) {
    const auto i = static_cast<Eigen::Index>(n);
    x[i] = std::clamp(x[i], unknowns[n].lower, unknowns[n].upper);
  }
  return x;
}

std::vector<Eigen::VectorXd> fit_starts(const FitProblem& problem, const Eigen::VectorXd& given, int drawn,
                                        std::uint64_t seed) {
  std::vector<Eigen::VectorXd> starts = {given};
  const Candidate c = problem.candidate_at(given);
  Eigen::VectorXd second = given;
  const auto neutral = effects_at_neutral(problem, c, given);
  for (const auto& [effect, places] : neutral) {
    choose_phases(problem, places, second);
    choose_shapes(problem, places, second);
    choose_strengths(problem, places, second);
  }
  if (!neutral.empty()) starts.push_back(second);
  for (int n = 1; n < drawn; ++n) {
    Eigen::VectorXd x = starts.back();
    for (std::size_t u = 0; u < problem.unknowns().size(); ++u) {
      const Unknown& unknown = problem.unknowns()[u];
      const double normal = gaussian(seed, stream_of("fit_starts") + u, static_cast<std::uint64_t>(n));
      const bool periodic = unknown.trait == ParamTrait::kPeriodic;
      const double sigma =
          unknown.prior_sigma > 0.0 ? std::min(unknown.prior_sigma, unknown.scale) : 0.3 * unknown.scale;
      x[static_cast<Eigen::Index>(u)] += normal * (periodic ? 1.5 : sigma);
    }
    starts.push_back(within_bounds(problem.unknowns(), x));
  }
  return starts;
}

}  // namespace omnihil
