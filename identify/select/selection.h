// Who wins a round: probabilities, twins, the one that is taken.
//
//   settle(search, parent, round);     // orders round.contenders, sets chosen, twins and probabilities
//
// Probability: in how many draws of a block bootstrap of the held-out runs an effect leaves the least error;
// those that leave nearly as little share the draw; a draw in which none takes as much as matters goes to
// "none". Where nothing is accepted but what lets a base parameter come back (soundness.h), that has all.
// Twins: contenders that pass and either take nearly the same from the error, or whose signals are nearly one
// and the same once the base parameters have moved along. Of twins the one with the fewest numbers is named
// first.
#pragma once
#include "identify/select/selection_iteration.h"

namespace omnihil {

void select_best(const SelectionTask& task, const Fitted& parent, Iteration& iteration);

// The gain that decides (held-out runs and fit runs alike; without held-out runs the latter), less a little
// for every further number: a law of many numbers bends to what it does not mean.
double penalised_gain(const CandidateEffect& c, bool has_holdout);

// Does either one's page name the other?
bool listed_as_confounded(const EffectInfo& a, const EffectInfo& b);

// Cosine between the signals of two screened effects, both beside the base parameters.
double cosine_similarity(const Screened& a, const Screened& b);

}  // namespace omnihil
