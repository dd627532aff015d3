#include "identify/select/idle_effect.h"

#include <fmt/format.h>

#include <algorithm>

namespace omnihil {

Candidate with_idle_effect(const Candidate& model, const std::string& name) {
  constexpr double kIdle = 1e-6;  // of the strengths: not neutral, and below any resolution; a choice
  Candidate out = model;
  for (EffectUse& use : out.effects) {
    if (use.entry->info->id != name) continue;
    const std::uint32_t numerics = use.entry->info->numerics;
    if ((numerics & kImpacts) != 0 || (numerics & (kStiff | kFine)) == 0) return without_effect(model, name);
    for (std::size_t i = 0; i < use.values.size(); ++i) {
      const EffectParam& row = use.entry->info->params[i];
      if (row.role != ParamRole::kShape) use.values[i] = row.neutral + kIdle * (use.values[i] - row.neutral);
    }
  }
  return out;
}

std::string gain_not_its_own(const WhitenedResiduals& training, const Eigen::VectorXd& with,
                             const Eigen::VectorXd& idle) {
  if (idle.size() != with.size()) return "";  // without it the model does not stay finite
  const double rise = energy_ratio(training, with, idle) - 1.0;
  if (rise >= kLeastFitGain) return "";
  return fmt::format(
      "its gain is that of the base parameters and steps beside it: without it the error energy rises by "
      "{:.2g} % only",
      100.0 * std::max(rise, 0.0));
}

std::string gain_not_its_own(const WhitenedResiduals& training, const Fitted& with, const std::string& name,
                             int jobs) {
  return gain_not_its_own(training, with.residual[kTraining],
                          training.residual(with_idle_effect(with.fit.model, name), jobs));
}

}  // namespace omnihil
