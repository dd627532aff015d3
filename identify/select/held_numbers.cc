#include "identify/select/held_numbers.h"

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

std::optional<AcceptanceResult> accepted_at_belief(const SelectionTask& task, const RefitSetup& setup,
                                                   const Fitted& parent, const Fitted& child,
                                                   const AcceptanceResult& refused, const std::string& name,
                                                   double signal_to_null) {
  const AcceptanceContext& context = task.acceptance_context;
  if (refused.accepted() || !refused.decisive) return std::nullopt;
  const FitResult& base = context.base_fit != nullptr ? *context.base_fit : parent.fit;
  const std::vector<MovedNumber> moved = moved_numbers(base, parent.fit, child.fit, refused.decisive);
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
