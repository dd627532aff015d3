#include "identify/select/nested_law.h"

#include <algorithm>

#include "identify/select/effect_variants.h"

namespace omnihil {

std::optional<NestedLaw> nested_law(const SelectionTask& task, const RefitSetup& setup, const Fitted& current,
                                    const std::string& name) {
  const EffectUse* rich = use_of(current.fit.model, name);
  if (rich == nullptr || task.predictor->shows_signature_of(*rich->entry)) return std::nullopt;
  for (const std::string_view simpler : rich->entry->info->nests) {
    const auto entry = std::find_if(task.applicable.begin(), task.applicable.end(),
                                    [&](const EffectEntry* e) { return e->info->id == simpler; });
    if (entry == task.applicable.end() || use_of(current.fit.model, simpler) != nullptr) continue;
    const Candidate without = without_effect(current.fit.model, name);
    const Candidate with = with_use(without, at_typical_size(neutral_use(**entry), without));
    Fitted fitted = refit_to_convergence(setup, refit_as_it_is(setup, with, 1));
    if (!fitted.finite) continue;
    const AcceptanceResult earned =
        test_acceptance(task.acceptance_context, fitted, current, name, kScreenedBefore);
    // A gain that is decisive but refused for the values of its numbers is no reason for the simpler law either.
    if (earned.accepted() || earned.decisive) continue;
    return NestedLaw{.name = std::string(simpler), .fitted = std::move(fitted)};
  }
  return std::nullopt;
}

}  // namespace omnihil
