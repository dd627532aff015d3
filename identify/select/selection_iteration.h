// One iteration of the stepwise selection: which effect, if any, is added to the model next.
//
//   Iteration iteration = selection_iteration(task, parent);
//   iteration.ranking;   // every effect that applies, best first
//   iteration.chosen;    // index into iteration.candidates, or -1: none is accepted
//
// Method: forward selection. All effects are screened (linear), a shortlist is refitted in full, each
// candidate takes the acceptance test; of those that pass and are confounded the simplest is chosen, the
// others are kept as its set. The ranking is made anew in every iteration: what a larger effect masked shows
// once that one is in the model.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "identify/select/diagnosis.h"
#include "identify/select/refit.h"

namespace omnihil {

// What all iterations share.
struct SelectionTask {
  const Dataset* dataset = nullptr;
  const Predictor* predictor = nullptr;
  const Candidate* nominal = nullptr;
  const ComparedChannels* channels = nullptr;
  const Splits* splits = nullptr;      // whitened
  const Splits* unweighted = nullptr;  // in the channels' own units
  const NullModel* null = nullptr;
  AcceptanceContext acceptance_context;
  std::vector<const EffectEntry*> applicable;
  std::uint64_t seed = 1;
  int jobs = 1;
  // share of this iteration's work; false: stop with what is known
  std::function<bool(const std::string& doing, double share)> progress;
};

// An effect of the shortlist: screened, fitted in full, tested.
struct CandidateEffect {
  Screened screened;
  Fitted fitted;
  AcceptanceResult acceptance;
  std::string not_its_own{};         // idle_effect.h: why its gain does not count; empty: it does
  double selection_frequency = 0.0;  // share of the bootstrap's draws (selection.h)
};

// A candidate that may be meant instead of the chosen one.
struct ConfoundedCandidate {
  int index = -1;  // in Iteration::candidates
  double remaining =
      1.0;  // error energy above the sensors' noise that it leaves, in multiples of the chosen one's
};

struct Iteration {
  std::vector<Screened> screened;
  std::vector<CandidateEffect> candidates;  // best first
  std::vector<RankedEffect> ranking;
  int chosen = -1;
  std::vector<ConfoundedCandidate> confounded;
  std::vector<RankedEffect> earlier;  // of those that were not looked at again (near_best_again)
  double largest_null_gain = 0.0;     // of any effect in any replicate of the null
  std::vector<double> orders;         // dominant in the residual along the rotor's angle
  bool stopped = false;
};

Iteration selection_iteration(const SelectionTask& task, const Fitted& parent);

// The same among these effects alone, each of them refitted.
Iteration iteration_among(const SelectionTask& task, const Fitted& parent,
                          const std::vector<const EffectEntry*>& effects);

// Once more, beside a parent of the same structure that fits better: those that came near the best, each from where it ended.
// None, if what came near the best is a detail of an effect that is there already.
std::optional<Iteration> near_best_again(const SelectionTask& task, const Fitted& parent,
                                         const Iteration& before);

// Refuses the candidate that was chosen, for a reason that showed only when it was fitted to convergence, and
// chooses among the others.
void refuse_chosen(const SelectionTask& task, const Fitted& parent, const std::string& why,
                   Iteration& iteration);

// Tests the candidates again, by what the task's acceptance context is now, and chooses among those that pass.
void judge_anew(const SelectionTask& task, const Fitted& parent, Iteration& iteration);

// The iteration with further ones of its screened effects refitted, those that were not yet.
Iteration refitted_as_well(const SelectionTask& task, const Fitted& parent,
                           const std::vector<std::size_t>& screened, Iteration iteration);

// The screening alone: what these effects would gain, in the data and in the null.
Iteration screening_iteration(const SelectionTask& task, const Fitted& parent,
                              const std::vector<const EffectEntry*>& effects);

// Estimates of the parameters of one effect.
std::vector<ParameterEstimate> parameters_of(const FitResult& fit, const std::string& effect);

}  // namespace omnihil
