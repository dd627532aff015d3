#include "identify/select/add_effect.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

// Screened alone: shapes and sizes that the data ask for.
Screened screened_alone(const Search& search, const Fitted& parent, const EffectUse& use, double& chance) {
  Round round = screening_round(search, parent, {use.entry});
  chance = round.chance_gain;
  Screened s = round.screened.empty() ? Screened{} : std::move(round.screened.front());
  if (!s.tried || use.owner != nullptr) {
    s.start = use;
    s.entry = use.entry;
  }
  s.name = effect_name(use);
  return s;
}

}  // namespace

Addition add_effect(const Dataset& dataset, const Candidate& nominal, const EffectUse& use,
                    const AddOptions& options) {
  Addition out;
  Workbench bench(dataset, nominal, {.seed = options.seed, .jobs = options.jobs});
  out.why = bench.predictor().applies(*use.entry);
  out.applies = out.why.empty();
  if (!out.applies) return out;
  const auto say = [&](const std::string& doing, double share) {
    return !options.progress || options.progress({.doing = doing, .share = share});
  };
  const auto stop = [&] { return !say("fitting", 0.3); };
  if (!say("refitting the base parameters", 0.0) || !bench.fit_base(stop)) {
    out.why = "the model without it could not be fitted: it does not stay finite, or there are no fit runs";
    return out;
  }
  out.fit_before = bench.base().fit;
  out.before = compare(bench.predictor(), bench.base().fit.model);
  say("simulated null", 0.4);
  bench.simulate();
  std::vector<std::string> ignored;
  const Search search = bench.search(ignored);
  double chance = 0.0;
  const Screened start = screened_alone(search, bench.base(), use, chance);
  say("refitting with " + start.name, 0.6);
  Fitted with = refit(bench.setup(false, stop), bench.base(), start);
  const double gained = (energy_ratio(bench.uses()[0], with.residual[0], bench.base().residual[0]) - 1.0);
  const double over_chance = start.tried ? start.gain / std::max(chance, 1e-300) : (gained > 0.0 ? 1e9 : 0.0);
  const Judgement judgement =
      judge(search.judging, bench.base(), with, start.name, over_chance, start.stands_for());
  out.useful = judgement.accepted;
  out.why = judgement.why;
  out.fit_after = with.fit;
  out.after = compare(bench.predictor(), with.fit.model);
  say("done", 1.0);
  return out;
}

}  // namespace omnihil
