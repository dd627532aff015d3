// One effect added to a model by hand: what it changes, and whether it passes the acceptance test.
//
//   Addition a = add_effect(dataset, nominal, use, {.seed = 1, .jobs = 2});
//   a.before.error(Split::kValidation, "velocity")->rmse;
//   a.useful; a.why;       // "held-out error energy falls by 31 %"
//
// The base parameters are fitted without it and with it; the acceptance test is that of a diagnosis.
#pragma once
#include "identify/select/selection_context.h"

namespace omnihil {

struct Addition {
  bool applies = true;  // false: it cannot act on this rig; `why` says why
  bool useful = false;
  std::string why;
  FitResult fit_before, fit_after;
  Comparison before, after;
};

struct AddOptions {
  std::uint64_t seed = 1;
  int jobs = 1;
  std::function<bool(const Progress&)> progress;  // false: give up
};

// `use`: the effect, or a user's formula, at values to start from; strengths at neutral start from the
// screening.
Addition add_effect(const Dataset& dataset, const Candidate& nominal, const EffectUse& use,
                    const AddOptions& options);

}  // namespace omnihil
