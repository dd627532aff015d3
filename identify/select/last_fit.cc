#include "identify/select/last_fit.h"

#include <algorithm>

#include "identify/select/innovations.h"
#include "identify/select/plausibility.h"

namespace omnihil {

std::optional<Fitted> last_fit(const SelectionTask& task, RefitSetup setup, const Fitted& current,
                               const EffectsFound& found) {
  // Energy of the robust fit, in that of least squares, from which it counts as diverged; sensitivity not measured.
  constexpr double kRobustLoss = 1.2;  // tuned
  setup.robust = true;
  Fitted last =
      numbers_by_innovations(task, refit_as_it_is(setup, current.fit.model, 1), found.by_innovations);
  const auto to_bound = [&](const std::string& name) { return !ends_at_bound(last.fit, name).empty(); };
  if (!last.finite || std::ranges::any_of(found.names, to_bound)) return std::nullopt;
  const double loss =
      energy_ratio((*task.splits)[kTraining], current.residual[kTraining], last.residual[kTraining]);
  return loss < kRobustLoss ? std::optional(std::move(last)) : std::nullopt;
}

}  // namespace omnihil
