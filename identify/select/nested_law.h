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

// A simpler law with another one beside it, in place of a rich law whose shapes imitated the other.
struct SplitLaw {
  std::string simpler;
  Fitted with_simpler;
  Iteration iteration;  // from there, of the other one alone, which it chose
  Fitted fitted;        // with both
};
// `other`: what was refused beside the rich law. Method: it is tested as an addition to the simpler law. Both take the rich law's
// place if they have no more numbers and leave less in every split of the runs. Empty otherwise, and where nested_law() would be.
std::optional<SplitLaw> split_law(const SelectionTask& task, const RefitSetup& setup, const Fitted& current,
                                  const std::string& name, std::string_view other);

}  // namespace omnihil
