// The numbers of the answer, once its effects are known: a fit that a few runs which the model cannot explain do not bias.
//
//   if (std::optional<Fitted> last = last_fit(task, setup, current, found)) current = std::move(*last);
//
// Method: Huber's loss (Holland, Welsch, Commun. Stat. A6(9), 1977), from where the search ended; of effects that were accepted by the
// innovations the numbers are those that fit the innovations best.
#pragma once
#include <optional>

#include "identify/select/elimination.h"
#include "identify/select/refit.h"
#include "identify/select/selection_iteration.h"

namespace omnihil {

// Empty: it diverged, or takes a number of an effect to a bound. setup: thorough, of the task's context.
std::optional<Fitted> last_fit(const SelectionTask& task, RefitSetup setup, const Fitted& current,
                               const EffectsFound& found);

}  // namespace omnihil
