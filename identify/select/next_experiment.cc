#include "identify/select/next_experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "identify/record/rig.h"
#include "identify/select/angle_resolution.h"
#include "sim/law/effect_registry.h"

namespace omnihil {
namespace {

// What the file says of an effect; null: a base parameter or a formula.
const EffectInfo* info_of(const std::string& id) {
  const EffectEntry* entry = find_effect(id);
  return entry != nullptr ? entry->info : nullptr;
}

// Effects by the motion that reveals them; confounded with a base parameter, by a measurement of their own.
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

bool is_effect(const std::string& member) { return info_of(member) != nullptr; }

// The set that decides a name comes before one that decides a number; among equals the one of the larger effect,
// as they are listed.
const ConfoundedSet& most_decisive(const std::vector<ConfoundedSet>& sets) {
  const auto names = std::find_if(sets.begin(), sets.end(), [](const ConfoundedSet& set) {
    return std::count_if(set.members.begin(), set.members.end(), is_effect) > 1;
  });
  return names != sets.end() ? *names : sets.front();
}

// What a person can do to see more of a residual that depends on one thing. Not everything can be swept at leisure.
struct Sweep {
  std::string_view against, what;
};
constexpr Sweep kSweeps[] = {
    {"time",
     "Repeat one run from cold and, without a pause, from warm: what drifts with time differs between them"},
    {"time_since_step",
     "Record single steps of several heights, each until it has settled, from rest and from speed"},
    {"acceleration",
     "Record steps and chirps of several heights about the same speeds: accelerations differ, speeds do not"},
    {"abs_current", "Record the same speeds with several loads: the current differs, the speed does not"},
    {"abs_command", "Record a staircase of the drive's input, up and down, each step until it has settled"},
    {"direction", "Record the same staircase of the drive's input in both directions"},
    {"rotor_angle", "Turn slowly and steadily through several turns, in both directions"},
    {"output_angle", "Turn slowly and steadily through several turns of the output, in both directions"},
    {"temperature", "Repeat one run from cold and from warm"},
    {"bus_voltage", "Repeat one run at two supply voltages"}};

std::string sweep_over(std::string_view against) {
  for (const Sweep& s : kSweeps) {
    if (s.against == against) return std::string(s.what);
  }
  return fmt::format("Record slow and steady sweeps over {} in both directions, all else held constant",
                     against);
}

// The rivals of `omnihil experiment`: effects, and "base" where the other one is a base parameter.
std::string command_for(const Dataset& dataset, const std::vector<std::string>& members) {
  std::vector<std::string> rivals;
  std::copy_if(members.begin(), members.end(), std::back_inserter(rivals), is_effect);
  if (rivals.empty() || !dataset.rig->no_plan.empty()) return "";
  if (rivals.size() == 1) rivals.push_back("base");
  return fmt::format("omnihil experiment {} --separate {} --out next", dataset.name, fmt::join(rivals, ","));
}

}  // namespace

NextExperiment next_experiment(const Dataset& dataset, const Diagnosis& diagnosis) {
  NextExperiment next;
  if (!diagnosis.confounded.empty()) {
    next.separates = most_decisive(diagnosis.confounded).members;
    next.command = command_for(dataset, next.separates);
    next.what =
        fmt::format("To separate {}: {}", fmt::join(next.separates, " and "), revealing(next.separates));
    return next;
  }
  if (diagnosis.verdict == Verdict::kUnknown && !diagnosis.where.empty()) {
    const Where& w = diagnosis.where.front();
    next.what = fmt::format("{} ({} explains {:.0f} % of the residual of {}).", sweep_over(w.against),
                            w.against, 100.0 * w.explained_fraction, w.signal);
    return next;
  }
  // The first in the ranking that these data could not show.
  for (const RankedEffect& r : diagnosis.ranking) {
    const EffectInfo* info = info_of(r.effect);
    const bool hidden = r.visibility == Visibility::kAliased || r.visibility == Visibility::kBelowNoise ||
                        r.visibility == Visibility::kUnresolved;
    // What lacks a sensor, no motion shows.
    if (info == nullptr || !hidden || lacks_phase(*info, dataset)) continue;
    next.what = fmt::format("To see {}, which these data could not show: {}", r.effect, info->reveals);
    next.separates = {r.effect};
    next.command = command_for(dataset, next.separates);
    return next;
  }
  if (!dataset.has(Split::kExtrapolation)) {
    next.what =
        "Record another kind of motion (steps to full scale, or very slow turning) as an extrapolation run: "
        "so far the model is only tried on motion like that it was fitted to.";
    return next;
  }
  next.what =
      "Repeat one run unchanged: the difference of two like runs is the error that no model can go below.";
  return next;
}

}  // namespace omnihil
