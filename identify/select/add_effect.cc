#include "identify/select/add_effect.h"

#include <algorithm>
#include <cmath>

#include "identify/estimate/heard_commands.h"
#include "identify/select/idle_effect.h"
#include "identify/select/innovations.h"
#include "identify/select/verdict.h"

namespace omnihil {
namespace {

// Screened alone: shapes and sizes of largest gain.
Screened screened_alone(const SelectionTask& task, const Fitted& parent, const EffectUse& use,
                        double& null_gain) {
  Iteration iteration = screening_iteration(task, parent, {use.entry});
  null_gain = iteration.largest_null_gain;
  Screened s = iteration.screened.empty() ? Screened{} : std::move(iteration.screened.front());
  if (!s.tried || use.owner != nullptr) {
    s.start = use;
    s.entry = use.entry;
  }
  s.name = effect_name(use);
  return s;
}

}  // namespace

Addition add_effect(const Dataset& recorded, const Candidate& nominal, const EffectUse& use,
                    const AddOptions& options) {
  Addition out;
  const auto say = [&](const std::string& doing, double share) {
    return !options.progress || options.progress({.doing = doing, .share = share});
  };
  const auto stop = [&] { return !say("fitting", 0.3); };
  const Dataset dataset = heard_commands(recorded, nominal, {.jobs = options.jobs, .stop = stop}).dataset;
  SelectionContext context(dataset, nominal, {.seed = options.seed, .jobs = options.jobs});
  out.why = why_not(*use.entry, context.predictor(), dataset);
  out.applies = out.why.empty();
  if (!out.applies) return out;
  if (!say("refitting the base parameters", 0.0) || !context.fit_base(stop)) {
    out.why = "the model without it could not be fitted: it does not stay finite, or there are no fit runs";
    return out;
  }
  out.fit_before = context.base().fit;
  out.before = compare(context.predictor(), context.base().fit.model);
  say("simulated null", 0.4);
  context.simulate();
  std::vector<std::string> ignored;
  SelectionTask task = context.task(ignored);
  double null_gain = 0.0;
  const Screened start = screened_alone(task, context.base(), use, null_gain);
  say("refitting with " + start.name, 0.6);
  Fitted with = refit(context.setup(false, stop), context.base(), start);
  const double gained = (energy_ratio(context.splits()[kTraining], with.residual[kTraining],
                                      context.base().residual[kTraining]) -
                         1.0);
  const double signal_to_null =
      start.tried ? start.gain / std::max(null_gain, 1e-300) : (gained > 0.0 ? kScreenedBefore : 0.0);
  const WhitenedResiduals& training = context.splits()[kTraining];
  const std::string not_its_own =
      use.owner == nullptr ? gain_not_its_own(training, with, start.name, options.jobs) : "";
  const auto test = [&] {
    AcceptanceResult result = test_acceptance(task.acceptance_context, context.base(), with, start.name,
                                              signal_to_null, start.aliased_parameter());
    if (result.accepted_by == AcceptedBy::kGain) result.refuse(not_its_own);
    return result;
  };
  AcceptanceResult acceptance = test();
  if (not_its_own.empty()) {
    auto held = accepted_at_belief(task, context.setup(false, stop), context.base(), with, acceptance,
                                   start.name, signal_to_null);
    if (held) acceptance = std::move(*held);
  }
  if (!acceptance.accepted()) {
    AcceptanceResult fast = test_by_innovations(task, context.base(), with, start.name);
    if (fast.accepted()) {
      acceptance = std::move(fast);
      with = numbers_by_innovations(task, std::move(with), {start.name});
    }
  }
  if (!acceptance.accepted()) {
    task.acceptance_context.structure_remains = true;
    const AcceptanceResult small = test();
    const Candidate& base = context.base().fit.model;
    if (small.accepted() &&
        structure_remains(ResidualExcesses(context, base, base, options.seed, options.jobs).alike(), false))
      acceptance = small;
  }
  out.useful = acceptance.accepted() && start.is_resolved();
  out.why = start.is_resolved() ? acceptance.why : std::string(kPhaseUnresolved);
  out.fit_after = with.fit;
  out.after = compare(context.predictor(), with.fit.model);
  say("done", 1.0);
  return out;
}

}  // namespace omnihil
