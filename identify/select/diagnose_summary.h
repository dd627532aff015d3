// The lists of a diagnosis: confounded sets, and the variables that explain the residual.
#pragma once
#include "identify/select/selection_iteration.h"

namespace omnihil {

// Adds the set of the chosen effect with the candidates that are confounded with it, and that of the effect
// with the base parameter that its signal is aliased with.
void note_confounded(const Iteration& iteration, Diagnosis& diagnosis);

// The variables that explain most of a comparison's residual, the largest fraction first; `order`: dominant
// in the residual along the rotor's angle, 0: none.
std::vector<Where> where_of(const Comparison& comparison, double order);

}  // namespace omnihil
