#include "identify/select/selection_pair.h"

#include <algorithm>

namespace omnihil {
namespace {

// First effects that are tried, by cost: an iteration each.
constexpr std::size_t kMostFirst = 2;  // by cost
// Fall of the fit runs' energy from which a refused effect may be the first of a pair: three times the smallest gain of
// interest, so that it is told from what any law takes of a large residual. A choice; sensitivity not measured.
constexpr double kLeastFirstGain = 0.1;  // a choice

// Refused candidates by the fall of the fit runs' energy, largest first.
std::vector<const CandidateEffect*> first_effects(const SelectionTask& task, const Fitted& parent,
                                                  const Iteration& singles) {
  std::vector<std::pair<double, const CandidateEffect*>> by_gain;
  for (const CandidateEffect& c : singles.candidates) {
    if (c.acceptance.accepted() || !c.fitted.finite || c.screened.extends) continue;
    const double gain = 1.0 - energy_ratio((*task.splits)[kTraining], parent.residual[kTraining],
                                           c.fitted.residual[kTraining]);
    if (gain >= kLeastFirstGain) by_gain.emplace_back(gain, &c);
  }
  std::stable_sort(by_gain.begin(), by_gain.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (by_gain.size() > kMostFirst) by_gain.resize(kMostFirst);
  std::vector<const CandidateEffect*> out;
  out.reserve(by_gain.size());
  for (const auto& [gain, candidate] : by_gain) out.push_back(candidate);
  return out;
}

}  // namespace

EffectPair selection_pair(const SelectionTask& task, const Fitted& parent, const Iteration& singles) {
  EffectPair best;
  double least = 1.0;  // energy ratio of the fit runs to the parent's
  for (const CandidateEffect* first : first_effects(task, parent, singles)) {
    const Iteration further = selection_iteration(task, first->fitted);
    if (further.stopped) return {};
    if (further.chosen < 0) continue;
    const CandidateEffect& second = further.candidates[static_cast<std::size_t>(further.chosen)];
    if (second.screened.extends) continue;
    const auto passes = [&](const CandidateEffect& c) {
      return test_acceptance(task.acceptance_context, parent, second.fitted, c.screened.name, kScreenedBefore)
          .accepted();
    };
    const double ratio = energy_ratio((*task.splits)[kTraining], parent.residual[kTraining],
                                      second.fitted.residual[kTraining]);
    if (!(ratio < least) || !passes(*first) || !passes(second)) continue;
    least = ratio;
    best = {.names = {first->screened.name, second.screened.name},
            .aliased_parameters = {first->screened.aliased_parameter(), second.screened.aliased_parameter()},
            .fitted = second.fitted};
  }
  return best;
}

}  // namespace omnihil
