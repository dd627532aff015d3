#include "identify/select/strength_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/law/effect_registry.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

// Steps of the grid either side of the visible size, by powers of the root of two: from a quarter to four times.
constexpr int kSteps = 4;  // a choice

std::vector<double> strengths(const EffectUse& use, const Candidate& model) {
  const EffectParam& row = use.entry->info->params[first_strength(*use.entry->info)];
  const ParamRange range = param_range(row, model);
  const double fitted = use.values[first_strength(*use.entry->info)] - row.neutral;
  std::vector<double> out;
  for (const double sign : {1.0, -1.0}) {
    if (sign * fitted < 0.0) continue;  // its sign is what a fit does find
    for (int k = -kSteps; k <= kSteps; ++k) {
      const double value = row.neutral + sign * visible_size(row, model) * std::pow(2.0, 0.5 * k);
      if (value > range.lower && value < range.upper) out.push_back(value);
    }
  }
  return out;
}

Candidate with_strength(const Candidate& model, const EffectUse& use, double strength) {
  EffectUse changed = use;
  changed.values[first_strength(*use.entry->info)] = strength;
  return with_use(model, changed);
}

}  // namespace

std::vector<double> sizes_across_grid(const EffectParam& strength) {
  constexpr double kBeyond = 16.0;  // a quarter of the frequency of a resonance; a choice
  constexpr double kStep = 3.0;  // a choice: of a spring of 8 Hz fits descended from half to twice its size
  double least = 1.0, most = 1.0;
  for (const double size : strength.grid.at) {
    if (size > 0.0) least = std::min(least, size), most = std::max(most, size);
  }
  std::vector<double> out;
  for (double size = least; most > least && size <= kBeyond * most; size *= kStep) out.push_back(size);
  return out;
}

std::optional<Candidate> below_on_strength_grid(const RefitSetup& setup, const Candidate& model,
                                                const std::string& effect, const Eigen::VectorXd& residual) {
  const EffectUse* use = use_of(model, effect);
  if (use == nullptr) return std::nullopt;
  const WhitenedResiduals& fit = (*setup.splits)[kTraining];
  std::optional<Candidate> lowest;
  double least = 1.0;  // of `residual`'s energy
  for (const double strength : strengths(*use, model)) {
    if (setup.stop && setup.stop()) return lowest;
    Candidate at = with_strength(model, *use, strength);
    const Eigen::VectorXd left = fit.residual(fit.predicted_runs(at, setup.jobs));
    if (left.size() != residual.size() || !left.allFinite()) continue;
    const double ratio = energy_ratio(fit, residual, left);
    if (!(ratio < least)) continue;
    least = ratio;
    lowest = std::move(at);
  }
  return lowest;
}

}  // namespace omnihil
