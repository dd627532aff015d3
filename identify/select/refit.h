// A model with one more effect, fitted in full: from the screening's estimate, and from the neutral value
// where that fails. It never ends above the model without the effect.
//
//   Fitted child = refit(setup, parent, screened);
//   child.fit.model;                                  // with the effect, all numbers fitted again
//
// Priors stay those of the nominal model through all additions: a parameter that drifts is seen to drift.
#pragma once
#include <functional>

#include "identify/select/acceptance.h"
#include "identify/select/screening.h"

namespace omnihil {

struct RefitSetup {
  const Predictor* predictor = nullptr;
  const Splits* splits = nullptr;
  const Splits* unweighted = nullptr;  // the same, not whitened
  const Candidate* nominal = nullptr;  // whose priors hold
  std::uint64_t seed = 1;
  int jobs = 1;
  int max_iterations = 12;
  bool coarse = true;            // rough covariance: for rankings
  bool profile = true;           // FitOptions, where not quick
  bool finish_undamped = false;  // FitOptions
  bool robust = false;           // FitOptions
  std::function<bool()> stop;    // true: give up early
};

// The candidate's unknowns, starting where it is, with the nominal model's priors.
std::vector<Unknown> unknowns_with_priors(const Candidate& candidate, const Candidate& nominal);

Fitted refit(const RefitSetup& setup, const Fitted& parent, const Screened& effect);

// The same model once more, thoroughly: covariance, flat directions, several starts.
Fitted refit_as_it_is(const RefitSetup& setup, const Candidate& model, int starts);

// Again from its own end until that is worth no more (at most three times): a fit weighs signals by what they
// leave at its start, and those of a search are short. Never worse than `model`.
Fitted refit_to_convergence(const RefitSetup& setup, Fitted model);

}  // namespace omnihil
