#include "identify/select/idle_effect.h"

#include <fmt/format.h>

#include <algorithm>

#include "identify/select/plausibility.h"

namespace omnihil {
namespace {

// Known exactly, as believed; false: an effect's, or the model has no such number.
bool hold(const std::string& path, const Candidate& nominal, Candidate& model) {
  Parameter* p = model.file.parameters.find(path);
  const Parameter* before = nominal.file.parameters.find(path);
  if (p == nullptr || before == nullptr) return false;
  p->values = {before->believed()};
  p->tolerance.reset();
  return true;
}

}  // namespace

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

std::optional<AcceptanceResult> accepted_at_belief(const SelectionTask& task, const RefitSetup& setup,
                                                   const Fitted& parent, const Fitted& child,
                                                   const AcceptanceResult& refused, const std::string& name,
                                                   double signal_to_null) {
  const AcceptanceContext& context = task.acceptance_context;
  if (refused.accepted() || !refused.decisive) return std::nullopt;
  const std::vector<MovedNumber> moved =
      moved_numbers(parent.fit, child.fit, refused.decisive, context.base_fit);
  if (moved.empty() || refused.why != moved.front().why) return std::nullopt;
  Candidate model = child.fit.model;
  for (const MovedNumber& m : moved) {
    if (!hold(m.path, *task.nominal, model)) return std::nullopt;
  }
  const Fitted held = refit_as_it_is(setup, model, 1);
  AcceptanceResult out = test_acceptance(context, parent, held, name, signal_to_null);
  const SplitGain AcceptanceResult::*decides =
      (*context.splits)[kValidation].empty() ? &AcceptanceResult::fit : &AcceptanceResult::holdout;
  const bool kept = 1.0 - (out.*decides).ratio >= kGainKept * (1.0 - (refused.*decides).ratio);
  return out.accepted() && kept ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace omnihil
