// Random effects that change a signal's variance and not its mean (jitter of the sampling instants): found by
// where the residual's variance is large.
//
//   std::optional<NoiseEffect> n = noise_effect({.predictor = &predictor, .model = &model}, effects);
//   n->use;         // the effect with its strength
//   n->explained;   // of the excess of the residual's variance over the sensors' noise, bin by bin
//
// Method: variances e_b of the residual in bins b of speed and acceleration; simulated, e_b(x) = e_b(0) + D_b
// (x / x_0)^a with D_b and a from two sizes of the strength x; estimated where sum of n_b (e_b / e_b(x) + log
// e_b(x)) is least on the fit runs (maximum likelihood of normal noise of variance e_b). Accepted where a new
// simulation explains the held-out runs' variances and the residual's autocorrelation is that of the
// simulation: a wrong law leaves a correlated residual, noise does not (DECISIONS 34).
// Limits: one strength per effect; says nothing of effects whose variance is within the sensors'.
#pragma once
#include <optional>
#include <vector>

#include "identify/estimate/fit.h"
#include "identify/select/acceptance.h"

namespace omnihil {

struct NoiseSearch {
  const Predictor* predictor = nullptr;
  const Splits* unweighted = nullptr;  // residuals in the channels' own units
  const Candidate* model = nullptr;
  std::uint64_t seed = 1;
};

struct NoiseEffect {
  EffectUse use;
  ParameterEstimate strength;
  double explained = 0.0;
};

// The one of these that explains most; empty: none does.
std::optional<NoiseEffect> noise_effect(const NoiseSearch& task,
                                        const std::vector<const EffectEntry*>& effects);

}  // namespace omnihil
