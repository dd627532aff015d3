#include "identify/select/nested_law.h"

#include <algorithm>

#include "identify/select/effect_variants.h"
#include "identify/select/plausibility.h"

namespace omnihil {
namespace {

// Null: it cannot act here.
const EffectEntry* applicable(const SelectionTask& task, std::string_view id) {
  const auto at = std::ranges::find(task.applicable, id, [](const EffectEntry* e) { return e->info->id; });
  return at == task.applicable.end() ? nullptr : *at;
}

// `model` with a law that `name` nests in its place, at its typical size; empty: it is not applicable, or there already.
std::optional<Candidate> with_nested(const SelectionTask& task, const Candidate& model,
                                     const std::string& name, std::string_view simpler) {
  const EffectEntry* entry = applicable(task, simpler);
  if (entry == nullptr || use_of(model, simpler) != nullptr) return std::nullopt;
  const Candidate without = without_effect(model, name);
  return with_use(without, at_typical_size(neutral_use(*entry), without));
}

// What laws it may give way to; none if the readings show its signature.
std::vector<std::string_view> simpler_than(const SelectionTask& task, const Candidate& model,
                                           const std::string& name) {
  const EffectUse* rich = use_of(model, name);
  if (rich == nullptr || task.predictor->shows_signature_of(*rich->entry)) return {};
  return {rich->entry->info->nests.begin(), rich->entry->info->nests.end()};
}

bool leaves_less(const Splits& splits, const Fitted& a, const Fitted& than) {
  for (std::size_t u = 0; u < kSplits; ++u) {
    if (!splits[u].empty() && !(energy_ratio(splits[u], than.residual[u], a.residual[u]) < 1.0)) return false;
  }
  return true;
}

}  // namespace

std::optional<NestedLaw> nested_law(const SelectionTask& task, const RefitSetup& setup, const Fitted& current,
                                    const std::string& name) {
  for (const std::string_view simpler : simpler_than(task, current.fit.model, name)) {
    const std::optional<Candidate> with = with_nested(task, current.fit.model, name, simpler);
    if (!with) continue;
    Fitted fitted = refit_to_convergence(setup, refit_as_it_is(setup, *with, 1));
    if (!fitted.finite) continue;
    const AcceptanceResult earned =
        test_acceptance(task.acceptance_context, fitted, current, name, kScreenedBefore);
    // A gain that is decisive but refused for the values of its numbers is no reason for the simpler law either.
    if (earned.accepted() || earned.decisive) continue;
    return NestedLaw{.name = std::string(simpler), .fitted = std::move(fitted)};
  }
  return std::nullopt;
}

std::optional<SplitLaw> split_law(const SelectionTask& task, const RefitSetup& setup, const Fitted& current,
                                  const std::string& name, std::string_view other) {
  const EffectEntry* entry = applicable(task, other);
  if (entry == nullptr || use_of(current.fit.model, other) != nullptr) return std::nullopt;
  for (const std::string_view simpler : simpler_than(task, current.fit.model, name)) {
    const std::optional<Candidate> with = with_nested(task, current.fit.model, name, simpler);
    if (!with || simpler == other) continue;
    SplitLaw out{.simpler = std::string(simpler),
                 .with_simpler = refit_to_convergence(setup, refit_as_it_is(setup, *with, 1)),
                 .iteration = {},
                 .fitted = {}};
    if (!out.with_simpler.finite || !ends_at_bound(out.with_simpler.fit, out.simpler).empty()) continue;
    out.iteration = iteration_among(task, out.with_simpler, {entry});
    if (out.iteration.chosen < 0) continue;
    out.fitted = refit_to_convergence(setup, out.iteration.candidates.front().fitted);
    const bool fewer = out.fitted.fit.parameters.size() <= current.fit.parameters.size();
    if (fewer && ends_at_bound(out.fitted.fit, std::string(other)).empty() &&
        leaves_less(*task.splits, out.fitted, current))
      return out;
  }
  return std::nullopt;
}

}  // namespace omnihil
