#include "identify/select/diagnose_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "identify/predict/predictor_axis.h"
#include "identify/select/selection.h"
#include "sim/law/effect_registry.h"

namespace omnihil {
namespace {

// For what is printed; no verdict depends on them. Residual fraction (1 - R^2) of an effect's signal below
// which the base parameter is named beside it, and fraction of a residual's variance that is worth a line: as
// the smallest gain of interest (acceptance.cc). Lines: a screenful. Choices.
constexpr double kNearlyAliased = 0.03;   // a choice
constexpr double kLeastExplained = 0.03;  // a choice
constexpr std::size_t kMostWhere = 6;     // a choice

std::string confounded_sentence(const ConfoundedSet& set) {
  std::vector<std::string> each;
  bool same = true;
  for (std::size_t m = 0; m < set.members.size(); ++m) {
    const double remaining = m < set.remaining.size() ? set.remaining[m] : 1.0;
    const bool more = remaining > kSameRemaining;
    same = same && !more;
    each.push_back(more ? fmt::format("{} (leaves {:.2g} times the error energy above the noise)",
                                      set.members[m], remaining)
                        : set.members[m]);
  }
  return fmt::format("These data cannot tell apart: {}. {}", fmt::join(each, ", "),
                     same ? "The first is the simplest; any of them explains the recording as well."
                          : "The first fits best; a drive is of neither form exactly, so that what fits less "
                            "well may yet be meant.");
}

void add_set(ConfoundedSet added, Diagnosis& diagnosis) {
  for (const ConfoundedSet& set : diagnosis.confounded) {
    std::vector<std::string> a = set.members, b = added.members;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    if (a == b) return;
  }
  if (added.sentence.empty()) added.sentence = confounded_sentence(added);
  diagnosis.confounded.push_back(std::move(added));
}

// Both make a settled speed fall short of the duty's: by a constant voltage, or in a bend.
void add_hidden_losses(const std::string& effect, bool has_current, Diagnosis& diagnosis) {
  std::erase_if(diagnosis.confounded,
                [&](const ConfoundedSet& set) { return set.members.front() == effect; });
  add_set({.members = {effect, "dead_time", "coast_mode"},
           .sentence = fmt::format(
               "These points cannot tell {} from a loss before the winding (dead_time, coast_mode and the "
               "like), which was not searched: {}record the motion.",
               effect, has_current ? "" : "measure the current as well, or ")},
          diagnosis);
}

// A motion that is taken as reported, and laws that are late between torque and motion.
void add_hidden_low_pass(const std::string& effect, Diagnosis& diagnosis) {
  const EffectEntry* const entry = find_effect(effect);
  if (entry == nullptr || (entry->info->place != Place::kShaft && entry->info->place != Place::kCommand))
    return;
  ConfoundedSet set{
      .members = {effect},
      .sentence = fmt::format(
          "The motion is taken as it is reported: a low pass of the speed (speed_low_pass), which "
          "looks like {}, was not searched: record a position, or drive by duty.",
          effect)};
  const auto known = std::ranges::find_if(diagnosis.confounded, [&](const ConfoundedSet& other) {
    return other.members.front() == effect && is_of_effects(other);
  });
  if (known != diagnosis.confounded.end()) {
    set.members = known->members;
    set.sentence = known->sentence + " " + set.sentence;
    diagnosis.confounded.erase(known);
  }
  set.members.emplace_back("speed_low_pass");
  add_set(std::move(set), diagnosis);
}

}  // namespace

bool is_of_effects(const ConfoundedSet& set) {
  return std::ranges::none_of(set.members,
                              [](const std::string& m) { return m.find('.') != std::string::npos; });
}

void note_confounded(const Iteration& iteration, Diagnosis& diagnosis) {
  if (iteration.chosen < 0) return;
  const CandidateEffect& chosen = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
  if (!iteration.confounded.empty()) {
    ConfoundedSet set{.members = {chosen.screened.name}, .sentence = {}, .remaining = {1.0}};
    for (const ConfoundedCandidate& c : iteration.confounded) {
      set.members.push_back(iteration.candidates[static_cast<std::size_t>(c.index)].screened.name);
      set.remaining.push_back(c.remaining);
    }
    add_set(std::move(set), diagnosis);
  }
  if (chosen.screened.residual_fraction < kNearlyAliased && !chosen.screened.closest_parameter.empty()) {
    add_set({.members = {chosen.screened.name, chosen.screened.closest_parameter},
             .sentence = fmt::format("{:.1f} % of the signal of {} is its own; the base parameters together, "
                                     "{} before all, produce the rest.",
                                     100.0 * chosen.screened.residual_fraction, chosen.screened.name,
                                     chosen.screened.closest_parameter)},
            diagnosis);
  }
}

void note_noise_effect(const std::string& name, double explained, std::vector<ParameterEstimate> parameters,
                       Diagnosis& diagnosis) {
  const auto ranked = std::ranges::find(diagnosis.ranking, name, &RankedEffect::effect);
  if (ranked == diagnosis.ranking.end()) return;
  ranked->accepted_by = AcceptedBy::kNoise;
  ranked->noise_share = explained;
  ranked->visibility = Visibility::kVisible;
  ranked->why = fmt::format("explains {:.0f} % of the held-out runs' variance above the sensors' noise",
                            100.0 * explained);
  ranked->parameters = std::move(parameters);
  if (diagnosis.effects.size() == 1) std::rotate(diagnosis.ranking.begin(), ranked, ranked + 1);
}

void replace_in_answer(const std::string& richer, const std::string& simpler, Diagnosis& diagnosis) {
  std::replace(diagnosis.effects.begin(), diagnosis.effects.end(), richer, simpler);
  std::vector<std::string> members{simpler, richer};
  std::erase_if(diagnosis.confounded, [&](const ConfoundedSet& set) {
    if (set.members.front() != richer) return false;
    for (const std::string& other : set.members) {
      const bool is_effect = find_effect(other) != nullptr;  // else a base parameter
      if (is_effect && std::find(members.begin(), members.end(), other) == members.end())
        members.push_back(other);
    }
    return true;
  });
  add_set({.members = std::move(members), .sentence = {}}, diagnosis);
}

void settle_confounded(const Dataset& dataset, Diagnosis& diagnosis) {
  const auto found = [&](const std::string& name) {
    return std::find(diagnosis.effects.begin(), diagnosis.effects.end(), name) != diagnosis.effects.end();
  };
  std::erase_if(diagnosis.confounded, [&](ConfoundedSet& set) {
    if (!found(set.members.front())) return true;
    if (std::none_of(set.members.begin() + 1, set.members.end(), found)) return false;
    ConfoundedSet left;
    for (std::size_t m = 0; m < set.members.size(); ++m) {
      if (m > 0 && found(set.members[m])) continue;
      left.members.push_back(set.members[m]);
      if (m < set.remaining.size()) left.remaining.push_back(set.remaining[m]);
    }
    left.sentence = confounded_sentence(left);
    set = std::move(left);
    return set.members.size() < 2;
  });
  if (takes_speed_as_reported(dataset)) {
    for (const std::string& effect : diagnosis.effects) add_hidden_low_pass(effect, diagnosis);
  }
  if (!hides_losses_before_winding(dataset)) return;
  const bool has_current = dataset.channel("motor_current") != nullptr;
  for (const std::string& effect : diagnosis.effects) add_hidden_losses(effect, has_current, diagnosis);
}

std::vector<Where> where_of(const Comparison& comparison, double order) {
  std::vector<Where> all;
  for (const RegimeError& r : comparison.regimes) {
    // A measured bus voltage is an input of the model: its residual is no structure of the drive.
    if (r.signal == "bus_voltage" || r.split == Split::kExtrapolation ||
        r.explained_fraction < kLeastExplained)
      continue;
    const auto same = std::find_if(
        all.begin(), all.end(), [&](const Where& w) { return w.signal == r.signal && w.against == r.axis; });
    if (same != all.end()) {
      // the smaller of fit and held-out runs: where they differ it is chance
      same->explained_fraction = std::min(same->explained_fraction, r.explained_fraction);
      continue;
    }
    all.push_back({.signal = r.signal,
                   .against = r.axis,
                   .explained_fraction = r.explained_fraction,
                   .order = r.axis == "rotor_angle" ? order : 0.0});
  }
  std::stable_sort(all.begin(), all.end(), [](const Where& a, const Where& b) {
    return a.explained_fraction > b.explained_fraction;
  });
  if (all.size() > kMostWhere) all.resize(kMostWhere);
  return all;
}

std::string reason_not_searched(const Diagnosis& diagnosis, bool misleading, bool stopped) {
  if (misleading) {
    return fmt::format("a fault of the data would be taken for an effect: {}",
                       first_fault(diagnosis.findings)->sentence);
  }
  const bool tried =
      !diagnosis.effects.empty() || std::ranges::any_of(diagnosis.ranking, [&](const RankedEffect& r) {
        return r.refitted || (!stopped && r.visibility != Visibility::kNotTried);
      });
  if (tried) return "";
  if (stopped) return kInterrupted;
  return diagnosis.ranking.empty() ? "none of the known effects can act on this bench"
                                   : "with every effect that was tried the model diverges";
}

std::vector<DataFinding> lost_commands(const HeardCommands& heard) {
  std::vector<DataFinding> out;
  for (std::size_t r = 0; r < heard.lost.size(); ++r) {
    const LostPackets& lost = heard.lost[r];
    if (std::string sentence = sentence_of(lost); !sentence.empty())
      out.push_back({DataFinding::Grade::kNote, "lost_commands", heard.dataset.runs[r].file, "command",
                     static_cast<double>(lost.rows.size()), std::move(sentence)});
  }
  return out;
}

std::string_view outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kFound:
      return "found";
    case Outcome::kMoreRemains:
      return "found, but more remains";
    case Outcome::kNothingFound:
      return "nothing found";
    case Outcome::kNotSearched:
      return "not searched";
  }
  return "";
}

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAdequate:
      return "adequate";
    case Verdict::kEffect:
      return "effect";
    case Verdict::kUnknown:
      return "unknown";
  }
  return "";
}

std::span<const LadderStep> steps_after_first_ranking(const Diagnosis& diagnosis) {
  const auto first = std::find_if(diagnosis.ladder.begin(), diagnosis.ladder.end(),
                                  [](const LadderStep& step) { return !step.ranking.empty(); });
  return first == diagnosis.ladder.end() ? std::span<const LadderStep>()
                                         : std::span<const LadderStep>(first + 1, diagnosis.ladder.end());
}

}  // namespace omnihil
