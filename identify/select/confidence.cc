#include "identify/select/confidence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include "identify/select/acceptance.h"
#include "sim/law/effect_registry.h"

namespace omnihil {
namespace {

// Coefficients of a logit, printed by `python3 tests/hidden_plant/calibrate.py`.
struct Map {
  double constant, later, per_decade_of_share, selection_frequency, undecided;
};
constexpr Map kNothingRemains{3.264, -0.090, 1.466, 1.595, 1.473};  // fitted
constexpr double kPerDecadeOverNoise = -12.291;                     // fitted, of the same
constexpr Map kMoreRemains{-0.159, -1.019, 0.996, 1.160, 0.869};    // fitted
// From here on the made records hold too few names to tell (calibrate.py).
constexpr double kMostOverNoise = 2.0;  // a choice
// The calibration saw a few hundred names: it cannot tell surer ones apart.
constexpr double kSurest = 0.99;  // a choice
// Shares below are one and the same: none is accepted for its gain (acceptance.cc).
constexpr double kLeastShareOfBase = 1e-3;  // a choice
// The noise's level is not known so well that less could be told from nothing.
constexpr double kLeastRemaining = 1e-3;  // a choice

// Share of the base model's energy that the form of a law may leave to a second law of the same quantity. Of the six such names
// with a share of 1 to 2 % that two independent generators and 70 pairs gave, three were right, whatever the share.
constexpr double kFormShare = 0.02;    // measured, as said
constexpr double kRightBelowIt = 0.5;  // measured, as said
// How likely is a second law of a quantity that takes this share of the base model's energy, and not the form of the first? Forms
// that leave a multiple of kFormShare are rarer by its square.
double of_another_law(double share_of_base) {
  const double ratio = share_of_base / kFormShare;
  return std::max(kRightBelowIt, ratio * ratio / (1.0 + ratio * ratio));
}

bool has_kin_before(const std::vector<NameConfidence>& before, std::string_view name) {
  const EffectEntry* entry = find_effect(name);
  return entry != nullptr && std::ranges::any_of(before, [&](const NameConfidence& c) {
           const EffectEntry* other = find_effect(c.effect);
           return other != nullptr && is_kin(*other->info, *entry->info);
         });
}

// Root mean square over the signals; at least 1. A measured bus voltage is an input.
double error_over_noise(const Comparison& comparison, Split split) {
  double square = 0.0, signals = 0.0;
  for (const SignalError& e : comparison.errors) {
    const bool counts = e.split == split && e.signal != "bus_voltage" && e.noise_sigma > 0.0;
    if (!counts || !std::isfinite(e.rmse)) continue;
    square += e.rmse * e.rmse / (e.noise_sigma * e.noise_sigma);
    signals += 1.0;
  }
  return std::max(signals > 0.0 ? std::sqrt(square / signals) : 0.0, 1.0);
}

// What the search knew of a name when it took it.
struct Taken {
  double share_of_base = 0.0;
  double selection_frequency = 0.0;
};

// Two that were taken together because either alone gains nothing: what the step removes of the base model's energy above the noise
// is both one's. steps: before, after.
double share_of_step(const Diagnosis& d, const LadderStep& before, const LadderStep& after) {
  const auto square = [&](const Comparison& c) {
    return std::pow(error_over_noise(c, Split::kValidation), 2);
  };
  const double all = square(d.baseline_comparison) - 1.0;
  return all > 0.0 ? std::clamp((square(before.comparison) - square(after.comparison)) / all, 0.0, 1.0) : 0.0;
}

// By the row of the ranking that each name was taken from; a law in place of another has the other's.
std::map<std::string, Taken> rows_taken(const Diagnosis& d) {
  static constexpr std::string_view kAnd = " and ", kReplaces = " in place of ";
  std::map<std::string, Taken> out;
  for (std::size_t i = 0; i + 1 < d.ladder.size(); ++i) {
    const LadderStep &before = d.ladder[i], &after = d.ladder[i + 1];
    const bool together = after.added.find(kAnd) != std::string::npos;
    const std::string added = fmt::format(" and {} and ", after.added);
    for (const RankedEffect& r : before.ranking) {
      if (added.find(fmt::format(" and {} and ", r.effect)) == std::string::npos) continue;
      out[r.effect] = {std::max(r.share_of_base, together ? share_of_step(d, before, after) : 0.0),
                       r.selection_frequency};
    }
  }
  for (const LadderStep& step : d.ladder) {
    const std::size_t at = step.added.find(kReplaces);
    if (at == std::string::npos) continue;
    const auto old = out.find(step.added.substr(at + kReplaces.size()));
    if (old != out.end()) out[step.added.substr(0, at)] = old->second;
  }
  return out;
}

// The runs of which the last model leaves more: held-out ones may lack the motion that a wrong law cannot follow.
Split worse_split(const Comparison& last) {
  return error_over_noise(last, Split::kTraining) > error_over_noise(last, Split::kValidation)
             ? Split::kTraining
             : Split::kValidation;
}

double logit(const Map& map, const NameEvidence& e, double share) {
  return map.constant + map.later * e.later + map.per_decade_of_share * std::log10(share) +
         map.selection_frequency * e.selection_frequency + map.undecided * e.undecided;
}

}  // namespace

double probability_right(const NameEvidence& e) {
  const double share = std::clamp(e.share_of_base, kLeastShareOfBase, 1.0);
  const double remaining = std::clamp(e.remaining_share, kLeastRemaining, 1.0);
  const double over_noise = std::log10(std::clamp(e.error_over_noise, 1.0, kMostOverNoise));
  const double sum = e.more_remains ? logit(kMoreRemains, e, share / remaining)
                                    : logit(kNothingRemains, e, share) + kPerDecadeOverNoise * over_noise;
  return std::clamp(1.0 / (1.0 + std::exp(-sum)), 1.0 - kSurest, kSurest);
}

std::vector<NameConfidence> confidences(const Diagnosis& d) {
  const auto rows = rows_taken(d);
  const Split split = worse_split(d.final_comparison);
  const double over_noise = error_over_noise(d.final_comparison, split),
               before = error_over_noise(d.baseline_comparison, split);
  const double remaining = (over_noise * over_noise - 1.0) / std::max(before * before - 1.0, 1e-9);
  std::vector<NameConfidence> out;
  for (const std::string& name : d.effects) {
    NameEvidence e{.later = !out.empty(),
                   .more_remains = d.outcome == Outcome::kMoreRemains,
                   .share_of_base = 0.0,
                   .selection_frequency = 0.0,
                   .error_over_noise = over_noise,
                   .remaining_share = remaining};
    if (const auto row = rows.find(name); row != rows.end()) {
      e.share_of_base = row->second.share_of_base;
      e.selection_frequency = row->second.selection_frequency;
    }
    const auto noise = std::ranges::find_if(d.ranking, [&](const RankedEffect& r) {
      return r.effect == name && r.accepted_by == AcceptedBy::kNoise;
    });
    if (noise != d.ranking.end()) e.share_of_base = noise->noise_share, e.selection_frequency = 1.0;
    e.undecided = std::ranges::any_of(d.confounded, [&](const ConfoundedSet& set) {
      return set.members.size() > 1 && std::ranges::find(set.members, name) != set.members.end();
    });
    const double another = has_kin_before(out, name) ? of_another_law(e.share_of_base) : 1.0;
    out.push_back({.effect = name, .probability = probability_right(e) * another});
  }
  return out;
}

std::string confidence_sentence(const Diagnosis& d) {
  const bool in_a_set = std::ranges::any_of(d.confounded, is_of_effects);
  std::vector<std::string> each;
  for (const NameConfidence& c : d.confidence)
    each.push_back(fmt::format("{} in {:.0f} %", c.effect, 100.0 * c.probability));
  return each.empty()
             ? ""
             : fmt::format("Of made records with such evidence, the name{} was right: {}.",
                           in_a_set ? ", or one that it cannot be told from," : "", fmt::join(each, ", "));
}

NamesByLikelihood names_by_likelihood(const Diagnosis& d) {
  NamesByLikelihood out;
  for (const std::string& name : d.effects) {
    const auto said = std::ranges::find(d.confidence, name, &NameConfidence::effect);
    const bool unlikely = said != d.confidence.end() && said->probability < 0.5;
    (unlikely ? out.unlikely : out.likely).push_back(name);
  }
  return out;
}

}  // namespace omnihil
