// Which physical effect is missing: the whole way from a measurement and a nominal model to a verdict.
//
//   Diagnosis d = diagnose(dataset, nominal, {.seed = 1, .jobs = 2});
//   d.verdict; d.effects; d.ranking[0].selection_frequency; d.next_experiment.what;
//
// Method: stepwise selection. Data quality -> fit of the base parameters -> simulated null -> screening of
// every effect, per regime -> refit of a shortlist -> the best accepted one is added, and all are ranked
// again -> backward elimination -> confounded sets -> verdict -> next experiment. The same for a seed at any
// number of threads.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "identify/checks/check_data.h"
#include "identify/compare/comparison.h"
#include "identify/design/experiment.h"
#include "identify/estimate/fit.h"
#include "identify/record/progress.h"
#include "identify/select/ranked_effect.h"

namespace omnihil {

enum class Verdict : std::uint8_t { kAdequate, kEffect, kUnknown };
std::string_view verdict_name(Verdict verdict);  // "adequate", "effect", "unknown"

// What a person wants to know: were effects found, and is that all?
enum class Outcome : std::uint8_t { kFound, kMoreRemains, kNothingFound, kNotSearched };
std::string_view outcome_name(Outcome outcome);  // "found", "found, but more remains", "nothing found", …

// One step of the ladder: the model after an effect was added (the first: the refitted baseline; the
// one before it: the nominal model as given).
struct LadderStep {
  std::string added;  // effect, "nominal", "base parameters refitted", "removed X", "X in place of Y"
  Comparison comparison;
  std::vector<ParameterEstimate> parameters;
  std::vector<RankedEffect> ranking;  // the ranking that led to the next step
};

// What these data cannot tell apart: each member's signal can be made from another's, or they leave the same
// error.
struct ConfoundedSet {
  std::vector<std::string> members;  // effect ids and base-parameter paths
  std::string sentence;
  // Of each member: error energy above the sensors' noise that it leaves, in multiples of the first's; empty: not compared.
  std::vector<double> remaining = {};
};
bool is_of_effects(const ConfoundedSet& set);  // none of its members is a base parameter

struct Where {
  std::string signal;
  std::string against;  // RegimeTrack::name
  double explained_fraction = 0.0;
  double order = 0.0;  // of an angle: per turn; 0: none stands out
};

// Structure that no effect explains: the residual against one axis, and a formula for it.
struct UnknownStructure {
  std::vector<Where> where;
  std::vector<RegimeError> curves;  // with bands
  std::string formula;              // muParser; empty: none found
  std::string expression_toml;      // ready to paste: [effects.expression.NAME] …
  std::string sentence;
};

// Probability that a name of the answer, or one of those that the data cannot tell from it, is right (confidence.h).
struct NameConfidence {
  std::string effect;
  double probability = 0.0;
};

struct Diagnosis {
  std::string dataset;
  std::uint64_t seed = 1;
  std::vector<DataFinding> findings;
  FitResult baseline;
  Comparison nominal_comparison;
  Comparison baseline_comparison;
  Verdict verdict = Verdict::kUnknown;
  Outcome outcome = Outcome::kNothingFound;
  std::string not_searched;           // why no effect was tried; empty: one was
  std::string searched_despite;       // the data's fault that a search passed over; empty: none
  std::vector<std::string> effects;   // in the order in which they were added
  std::vector<RankedEffect> ranking;  // first iteration, best first: every effect that applies
  std::vector<LadderStep> ladder;
  std::vector<ConfoundedSet> confounded;
  std::vector<NameConfidence> confidence;  // one per effect
  std::vector<Where> where;
  UnknownStructure unknown;
  NextExperiment next_experiment;
  FitResult final_fit;
  Comparison final_comparison;
  bool complete = true;                  // false: interrupted; what is there is true as far as it goes
  std::vector<std::string> not_visible;  // effects that these data could not show, each with why
};

// The steps of the ladder behind the first one that has a ranking: their rankings are those of the further
// iterations.
std::span<const LadderStep> steps_after_first_ranking(const Diagnosis& diagnosis);

struct DiagnoseOptions {
  std::uint64_t seed = 1;
  int jobs = 1;
  int max_effects = 6;
  bool pairs = false;           // search two that mask each other also where others have been found
  bool despite_faults = false;  // search also where the data have a fault that can be taken for physics
  std::function<bool(const Progress&)> progress;  // false: stop with what is known
  std::function<bool()> stop;  // asked within every fit, from several threads; true: the same
};

Diagnosis diagnose(const Dataset& dataset, const Candidate& nominal, const DiagnoseOptions& options);

}  // namespace omnihil
