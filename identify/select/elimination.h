// Backward elimination: is an effect still needed beside those that were found after it?
//
//   const EffectsFound found{.names = names, .aliased_parameters = aliased};
//   if (auto less = unneeded_effect(task, setup, current, found, false)) current = less->fitted;
//
// Method: each effect in turn, the earliest first, is taken out and the rest fitted again; it stays if it is accepted as
// an addition to that, or if its gain alone proves it. One whose parameter went to a bound beside the later ones goes in
// any case. The latest was tested when it was added; once another one is gone (`since_removal`) that test was of another
// model, and it is tested again. One of a pair was refused alone: without its partner a large gain is not enough.
// Limits: one effect at a time; a set that is needed as a whole, and in no part, is taken apart.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "identify/select/refit.h"
#include "identify/select/selection_iteration.h"

namespace omnihil {

struct EffectsFound {
  std::vector<std::string> names;                         // in the order in which they were added
  std::map<std::string, std::string> aliased_parameters;  // Screened::aliased_parameter, by effect
  std::vector<std::string> pair;                          // that were accepted only together; empty: none
  std::vector<std::string> by_innovations{};              // that only those accept (innovations.h)
};

struct UnneededEffect {
  std::string name;
  Fitted fitted;  // without it
};

// Empty: all are needed, or `setup.stop`.
std::optional<UnneededEffect> unneeded_effect(const SelectionTask& task, const RefitSetup& setup,
                                              const Fitted& current, const EffectsFound& found,
                                              bool since_removal);

// The numbers of the answer, once its effects are known, with Huber's loss (Holland, Welsch, Commun. Stat. A6(9), 1977): a few runs
// that the model cannot explain do not bias them. Of effects that were accepted by the innovations they are those that fit the
// innovations best. Empty: it diverged, or takes a number of an effect to a bound. setup: thorough, of the task's context.
std::optional<Fitted> last_fit(const SelectionTask& task, RefitSetup setup, const Fitted& current,
                               const EffectsFound& found);

}  // namespace omnihil
