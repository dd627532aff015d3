#include "identify/select/next_experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "sim/law/effect_registry.h"

namespace omnihil {
namespace {

// What the file says of an effect; null: a base parameter or a formula.
const EffectInfo* info_of(const std::string& id) {
  const EffectEntry* entry = find_effect(id);
  return entry != nullptr ? entry->info : nullptr;
}

// Effects by the motion that shows them; where one is a base parameter's twin, by a measurement of its own.
std::string revealing(const std::vector<std::string>& members) {
  const bool with_base =
      std::any_of(members.begin(), members.end(), [](const std::string& m) { return info_of(m) == nullptr; });
  std::vector<std::string> parts;
  for (const std::string& m : members) {
    const EffectInfo* info = info_of(m);
    if (info == nullptr) continue;
    const std::string_view how = info->params[first_strength(*info)].how;
    parts.push_back(fmt::format("{}: {}", m, with_base && !how.empty() ? how : info->reveals));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

NextExperiment next_experiment(const Dataset& dataset, const Diagnosis& diagnosis) {
  NextExperiment next;
  if (!diagnosis.indistinguishable.empty()) {
    next.separates = diagnosis.indistinguishable.front().members;
    next.what = fmt::format("To part {}: {}", fmt::join(next.separates, " and "), revealing(next.separates));
    return next;
  }
  if (diagnosis.verdict == Verdict::kUnknown && !diagnosis.where.empty()) {
    const Where& w = diagnosis.where.front();
    next.what = fmt::format(
        "Record slow and steady sweeps over {} in both directions, the rest held constant: there {:.0f} % of "
        "what "
        "is left of {} lives.",
        w.against, 100.0 * w.explained_fraction, w.signal);
    return next;
  }
  // The likeliest of those that these data could not show.
  for (const RankedEffect& r : diagnosis.ranking) {
    const EffectInfo* info = info_of(r.effect);
    if (info == nullptr || !r.why.starts_with("not visible")) continue;
    next.what = fmt::format("To see {}, which these data could not show: {}", r.effect, info->reveals);
    next.separates = {r.effect};
    return next;
  }
  if (!dataset.has(Split::kExtrapolation)) {
    next.what =
        "Record another kind of motion (steps to full scale, or very slow turning) as an extrapolation run: "
        "so far the model is only tried on motion like that it was fitted to.";
    return next;
  }
  next.what =
      "Repeat one run unchanged: the difference of two like runs is the floor that no model can pass.";
  return next;
}

}  // namespace omnihil
