// A model with one more effect, fitted in full: from the screening's estimate, and from other starts where
// that does not reach what the screening predicts. Its residual energy never exceeds that of the model
// without the effect.
//
//   Fitted child = refit(setup, parent, screened);
//   child.fit.model;                                  // with the effect, all parameters fitted again
//
// Priors stay those of the nominal model through all additions, so prior deviations do too.
#pragma once
#include <functional>

#include "identify/select/acceptance.h"
#include "identify/select/screening.h"

namespace omnihil {

struct RefitSetup {
  const Predictor* predictor = nullptr;
  const Splits* splits = nullptr;
  const Splits* unweighted = nullptr;  // in the channels' own units
  const Candidate* nominal = nullptr;  // whose priors hold
  const NullModel* null = nullptr;     // the level of noise; none: a strength's grid is not tried
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

// The base parameters at their prior means.
Candidate at_priors(const Candidate& model, const Candidate& nominal);

// All strengths at their typical sizes, for where neither the screening's estimate nor a start near neutral succeeds.
EffectUse at_typical_size(const EffectUse& use, const Candidate& model);

// The same model once more, thoroughly: covariance, flat directions, several starts.
Fitted refit_as_it_is(const RefitSetup& setup, const Candidate& model, int starts);

// Refit from its own optimum, re-weighting the channels by their residuals there, until the energy falls by
// less than kWorthAnother (at most kMostRepeats times). Never worse than `model`.
Fitted refit_to_convergence(const RefitSetup& setup, Fitted model);

}  // namespace omnihil
