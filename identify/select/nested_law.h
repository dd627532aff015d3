// Parsimony once all effects are known: is a law of the answer needed, or would one do that it becomes at a limit of
// its shapes?
//
//   if (const auto simpler = nested_law(task, setup, current, "grease_drag")) current = simpler->fitted;
//
// Method: the simpler law is fitted in its place, beside all others; the richer one stays if it is accepted as an
// addition to that (the test of nested models: the richer one bears the burden of proof). While other effects are
// still missing a rich law may win for what its shapes imitate of those.
// A law whose signature the readings show is needed for that.
// Limits: the laws that EffectInfo::nests names, and no others.
#pragma once
#include <optional>
#include <string>

#include "identify/select/refit.h"
#include "identify/select/screening.h"
#include "identify/select/selection_iteration.h"

namespace omnihil {

struct NestedLaw {
  std::string name;
  Fitted fitted;
};

// Empty: `name` nests none of the applicable laws, is better than each, or the readings show its signature.
std::optional<NestedLaw> nested_law(const SelectionTask& task, const RefitSetup& setup, const Fitted& current,
                                    const std::string& name);

}  // namespace omnihil
