// Two effects of which neither is accepted alone: one masks the other (a bridge in coast mode without the
// friction that bends its curve raises the error of every other motion, and the friction alone gains
// nothing).
//
//   const Iteration singles = selection_iteration(task, parent);
//   const EffectPair pair = selection_pair(task, parent, singles);     // after an iteration that chose none
//   if (pair.found()) pair.names;                                      // {"coast_mode", "coulomb_friction"}
//
// Method: of the refused candidates those that lower the error of the fit runs most are each taken as the
// parent of another iteration; a pair is accepted if both effects, added together, pass the acceptance test
// against the model with neither, and the second against the model with the first.
// Limits: pairs whose first effect gains nothing by itself are not found; no triples.
#pragma once
#include <string>
#include <vector>

#include "identify/select/selection_iteration.h"

namespace omnihil {

struct EffectPair {
  std::vector<std::string> names;  // in the order in which they were added; empty: none found
  std::vector<std::string> aliased_parameters;
  Fitted fitted;

  bool found() const { return !names.empty(); }
};

EffectPair selection_pair(const SelectionTask& task, const Fitted& parent, const Iteration& singles);

}  // namespace omnihil
