// Model selection among the refitted candidates of one iteration: the best, and those that these data cannot
// tell from it.
//
//   select_best(task, parent, iteration);
//   // orders iteration.candidates; sets chosen, confounded and their selection frequencies
//
// Selection frequency: in how many draws of a block bootstrap of the held-out runs a candidate leaves the
// least error; those that leave nearly as little share the draw; a draw in which none gains as much as
// kLeastDrawGain counts for none. It does not ask whether the candidate passed the acceptance test.
// Confounded with the best: candidates that pass and either gain nearly the same, or have nearly the same
// signal once the base parameters have been projected out, or win a tenth of the draws. Of those that leave
// the same error the one whose quantisation signature the readings show is preferred, else the one with the
// fewest parameters.
// Limits: the best is the one of largest penalised gain; no multiplicity control over the shortlist.
#pragma once
#include "identify/select/selection_iteration.h"

namespace omnihil {

// Ratio of remaining energies above the sensors' noise up to which two candidates leave the same.
inline constexpr double kSameRemaining = 1.15;  // tuned, as the shares of selection.cc
// Loss of gain within which an effect may be meant instead, if listed as confusable or of the same signal
// (DECISIONS 53).
inline constexpr double kConfoundedGain = 0.12;  // tuned
// Cosine of two signals that no refit separates: 4 % of either's energy (1 - 0.98^2) is its own.
inline constexpr double kConfoundedCosine = 0.98;  // tuned

void select_best(const SelectionTask& task, const Fitted& parent, Iteration& iteration);

// Gain (mean of held-out and fit runs; without held-out runs the latter) less a penalty per further
// parameter.
double penalised_gain(const CandidateEffect& c, bool has_holdout);

// Does either one's page name the other as easily confused?
bool listed_as_confounded(const EffectInfo& a, const EffectInfo& b);

// Does the richer law become the simpler one (an id) at a limit of its shapes?
bool nests(const EffectInfo& richer, std::string_view simpler);

// Of the signals of two screened effects, the base parameters projected out of both; 0 to 1.
double cosine_similarity(const Screened& a, const Screened& b);

}  // namespace omnihil
