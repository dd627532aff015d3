// One round of the search: which effect, if any, should the model have next.
//
//   Round r = selection_iteration(search, parent);
//   r.ranking;                 // every effect that applies, best first
//   r.chosen                   // index into r.contenders, or -1: none earns its place
//
// All effects are screened, the few that promise most are refitted in full, each is judged; of those that
// pass and cannot be told apart the simplest is taken and the others are kept as its twins. The ranking is
// made anew in every round: what was masked by a larger effect shows once that is in.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "identify/select/diagnosis.h"
#include "identify/select/refit.h"

namespace omnihil {

struct SelectionTask {
  const Dataset* dataset = nullptr;
  const Predictor* predictor = nullptr;
  const Candidate* nominal = nullptr;
  const ComparedChannels* channels = nullptr;
  const Splits* splits = nullptr;
  const Splits* unweighted = nullptr;  // the same, not whitened
  const NullModel* null = nullptr;
  AcceptanceContext acceptance_context;
  std::vector<const EffectEntry*> applicable;
  std::uint64_t seed = 1;
  int jobs = 1;
  // share of this round's work; false: stop with what is known
  std::function<bool(const std::string& doing, double share)> progress;
};

struct CandidateEffect {
  Screened screened;
  Fitted fitted;
  AcceptanceResult acceptance;
  double probability = 0.0;
};

struct Iteration {
  std::vector<Screened> screened;
  std::vector<CandidateEffect> candidates;  // refitted, best first
  std::vector<RankedEffect> ranking;
  int chosen = -1;
  std::vector<int> twins;          // of the chosen, in `contenders`
  double largest_null_gain = 0.0;  // the most that any effect gains in any replicate of the null
  std::vector<double> orders;      // that stand out in the residual along the rotor's angle
  bool stopped = false;
};

Iteration selection_iteration(const SelectionTask& task, const Fitted& parent);

// The screening alone: what these effects would gain, and what chance would.
Iteration screening_iteration(const SelectionTask& task, const Fitted& parent,
                              const std::vector<const EffectEntry*>& effects);

// Estimates of the parameters of one effect.
std::vector<ParameterEstimate> parameters_of(const FitResult& fit, const std::string& effect);

}  // namespace omnihil
