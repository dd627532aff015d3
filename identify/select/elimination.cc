#include "identify/select/elimination.h"

#include <algorithm>

#include "identify/select/innovations.h"
#include "identify/select/plausibility.h"

namespace omnihil {
namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool lost_its_partner(const EffectsFound& found, const std::string& name) {
  return has(found.pair, name) && std::any_of(found.pair.begin(), found.pair.end(),
                                              [&](const std::string& n) { return !has(found.names, n); });
}

// Is `current` accepted as an addition to the model without the effect?
AcceptanceResult need_of(const SelectionTask& task, const Fitted& less, const Fitted& current,
                         const EffectsFound& found, const std::string& name) {
  if (has(found.by_innovations, name)) return test_by_innovations(task, less, current, name);
  const auto aliased = found.aliased_parameters.find(name);
  return test_acceptance(task.acceptance_context, less, current, name, kScreenedBefore,
                         aliased == found.aliased_parameters.end() ? "" : aliased->second);
}

}  // namespace

std::optional<UnneededEffect> unneeded_effect(const SelectionTask& task, const RefitSetup& setup,
                                              const Fitted& current, const EffectsFound& found,
                                              bool since_removal) {
  for (const std::string& name : found.names) {
    const bool symptom = !ends_at_bound(current.fit, name).empty();
    if (name == found.names.back() && !since_removal && !symptom) return std::nullopt;
    if (setup.stop && setup.stop()) return std::nullopt;
    Fitted less = refit_as_it_is(setup, without_effect(current.fit.model, name), 1);
    if (!less.finite) continue;
    const AcceptanceResult needed = need_of(task, less, current, found, name);
    const bool by_size = needed.decisive && !lost_its_partner(found, name);
    if (!symptom && (needed.accepted() || by_size)) continue;
    return UnneededEffect{.name = name, .fitted = std::move(less)};
  }
  return std::nullopt;
}

std::optional<Fitted> last_fit(const SelectionTask& task, RefitSetup setup, const Fitted& current,
                               const EffectsFound& found) {
  // Energy of the robust fit, in that of least squares, from which it counts as diverged; sensitivity not measured.
  constexpr double kRobustLoss = 1.2;  // tuned
  setup.robust = true;
  Fitted last =
      numbers_by_innovations(task, refit_as_it_is(setup, current.fit.model, 1), found.by_innovations);
  const auto to_bound = [&](const std::string& name) { return !ends_at_bound(last.fit, name).empty(); };
  if (!last.finite || std::ranges::any_of(found.names, to_bound)) return std::nullopt;
  const double loss =
      energy_ratio((*task.splits)[kTraining], current.residual[kTraining], last.residual[kTraining]);
  return loss < kRobustLoss ? std::optional(std::move(last)) : std::nullopt;
}

}  // namespace omnihil
