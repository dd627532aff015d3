// What a diagnosis says in its lists: twins, and where errors live.
#pragma once
#include "identify/select/selection_iteration.h"

namespace omnihil {

// The chosen effect, the contenders that cannot be told from it, and the base parameter that imitates it.
void note_confounded(const Iteration& iteration, Diagnosis& diagnosis);

// The axes that explain most of what a comparison leaves, the most telling first; `order` of the residual
// along the rotor's angle, 0: none stands out.
std::vector<Where> where_of(const Comparison& comparison, double order);

}  // namespace omnihil
