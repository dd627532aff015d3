// Which physical effect is missing: the whole way from a measurement and a nominal model to a verdict.
//
//   Diagnosis d = diagnose(dataset, nominal, {.seed = 1, .jobs = 2});
//   d.verdict; d.effects; d.ranking[0].probability; d.next_experiment.what;
//
// Way: data quality -> base fit -> simulated null -> screening of every effect, per regime -> forward refit
// of the best -> greedy addition with re-ranking -> backward elimination -> twins -> verdict -> next
// experiment. The same for a seed at any number of threads.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "identify/checks/check_data.h"
#include "identify/compare/comparison.h"
#include "identify/design/experiment.h"
#include "identify/estimate/fit.h"
#include "identify/record/progress.h"

namespace omnihil {

enum class Verdict : std::uint8_t { kAdequate, kEffect, kUnknown };
std::string_view verdict_name(Verdict verdict);  // "adequate", "effect", "unknown"

struct RankedEffect {
  std::string effect;
  double probability = 0.0;      // sums to at most 1 with "none"
  double score = 0.0;            // of the screening, null corrected
  double fit_error_ratio = 1.0;  // pooled error with the effect over that of the refitted baseline
  double holdout_error_ratio = 1.0;
  double extrapolation_error_ratio = 1.0;
  bool refitted = false;  // false: screening alone
  bool accepted = false;
  std::string why;  // in words: why it was accepted or refused; "not visible in these data: …"
  std::vector<ParameterEstimate> parameters;  // of the effect
};

// One step of the ladder: the model after an effect was added (the first: the refitted baseline; the
// one before it: the nominal model as given).
struct LadderStep {
  std::string added;  // effect, "nominal", "base parameters refitted", "removed X"
  Comparison comparison;
  std::vector<ParameterEstimate> parameters;
  std::vector<RankedEffect> ranking;  // the ranking that led to the next step
};

struct ConfoundedSet {
  std::vector<std::string> members;  // effect ids and base-parameter paths
  std::string sentence;
};

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

struct Diagnosis {
  std::string dataset;
  std::uint64_t seed = 1;
  std::vector<DataFinding> findings;
  FitResult baseline;
  Comparison nominal_comparison;
  Comparison baseline_comparison;
  Verdict verdict = Verdict::kAdequate;
  std::vector<std::string> effects;   // in the order in which they were added
  std::vector<RankedEffect> ranking;  // first round, best first: every effect that applies to the rig
  std::vector<LadderStep> ladder;
  std::vector<ConfoundedSet> indistinguishable;
  std::vector<Where> where;
  UnknownStructure unknown;
  NextExperiment next_experiment;
  FitResult final_fit;
  Comparison final_comparison;
  bool complete = true;                  // false: interrupted; what is there is true as far as it goes
  std::vector<std::string> not_visible;  // effects that these data could not show, each with why
};

struct DiagnoseOptions {
  std::uint64_t seed = 1;
  int jobs = 1;
  int max_effects = 6;
  std::function<bool(const Progress&)> progress;  // false: stop with what is known
  std::function<bool()> stop;  // asked within every fit, from several threads; true: the same
};

Diagnosis diagnose(const Dataset& dataset, const Candidate& nominal, const DiagnoseOptions& options);

}  // namespace omnihil
