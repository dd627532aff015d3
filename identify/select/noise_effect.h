// Effects that draw by chance and leave the mean as it is (jitter of the sampling instants): found by where
// the residual is loud, not by its course.
//
//   std::optional<NoiseEffect> n = noise_effect({.predictor = …, .model = last, …}, effects);
//   n->use;         // the effect with its strength
//   n->explained;   // of the excess of the residual's energy over the sensors' noise, regime by regime
//
// Method: energies e_b of the residual in bins b of speed and acceleration; simulated, e_b(x) = e_b(0) + D_b
// (x / x_0)^a with D_b and a from two sizes of the strength x; x where sum of n_b (e_b / e_b(x) + log e_b(x))
// is least on the fit runs (likelihood of normal noise). It stands where the held-out runs' bins agree with a
// new simulation and the residual is as uncorrelated as that: a wrong law leaves errors that go on, noise
// does not. Limits: one strength per effect; says nothing of effects whose noise is within the sensors'.
#pragma once
#include <optional>
#include <vector>

#include "identify/estimate/fit.h"
#include "identify/select/acceptance.h"

namespace omnihil {

struct NoiseSearch {
  const Predictor* predictor = nullptr;
  const Splits* unweighted = nullptr;  // not whitened
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
