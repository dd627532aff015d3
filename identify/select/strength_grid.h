// A grid of an effect's strength, for what a descent does not find: the energy has several valleys where the law acts on
// part of the record alone (a limit that the largest steps reach), and base parameters that have absorbed the effect bar the
// way to its own.
//
//   const auto lower = below_on_strength_grid(setup, at_priors(fitted.model, nominal), "duty_limit", residual);
//
// Grid: the visible size (effect_variants.h) times powers of the root of two, from a quarter to four times, of the sign that
// it has (at its neutral value: of both). Multi-start as in Ljung, System Identification, 1999, 10.5.
// Limits: one strength at a time, shapes and base parameters as in the model given; a valley that is narrower than a factor
// of the root of two is found only if its foot is below what was fitted.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "identify/select/refit.h"

namespace omnihil {

// Multiples of its visible size from the smallest of a strength's grid to beyond the largest, a factor of three apart: a resonance's
// frequency changes by the root of that, less than the width of the valley that a fit descends into. Empty: it has no grid.
std::vector<double> sizes_across_grid(const EffectParam& strength);

// The point of least whitened energy of the fit runs, with the model's other values; empty: none is below `residual`'s.
std::optional<Candidate> below_on_strength_grid(const RefitSetup& setup, const Candidate& model,
                                                const std::string& effect, const Eigen::VectorXd& residual);

}  // namespace omnihil
