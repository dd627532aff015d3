// Every effect that applies, scored in one pass: what it would gain if it were added to the fitted model.
//
//   ScreeningTask task{.predictor = …, .model = fitted, .base = &linear, .null = &null, …};
//   std::vector<Screened> s = screen(task, effects);       // in the order of `effects`
//   s[0].share;          // of the residual's energy that it would take away, null-corrected
//   s[0].start;          // the effect's numbers to start a refit from
//
// Per effect: difference signals (the model with the effect less the model without it) at a few shapes and
// sizes, less what the base parameters could do themselves, held against the residual; all samples together
// and in each regime alone (slow, steady, transient, fast), since an effect may live in a corner. The same
// search in the simulated null says what chance would have given.
// Limits: linear in the strengths about the sizes tried; what ranks high is refitted in full.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "identify/estimate/linear_base.h"
#include "identify/estimate/null_model.h"
#include "identify/select/effect_variants.h"

namespace omnihil {

// Samples of the fit runs that belong to one regime.
struct RegimeMask {
  std::string name;        // "slow"
  Eigen::VectorXd inside;  // 1 or 0
};
std::vector<RegimeMask> regime_masks(const WhitenedResiduals& residuals, const Candidate& model);

struct ScreeningTask {
  const WhitenedResiduals* residuals = nullptr;  // of the fit runs
  const Candidate* model = nullptr;
  const LinearBase* base = nullptr;
  std::vector<Eigen::VectorXd> noise;  // weighted residuals of the null
  std::vector<RegimeMask> regimes;
  DataScale scale;
  int jobs = 1;
  std::function<bool(double share)> progress;  // false: give up
};

struct Screened {
  const EffectEntry* entry = nullptr;
  std::string name;                // of the effect
  bool extends = false;            // further strengths of an effect that is there already
  double gain = 0.0;               // of the weighted sum of squares
  double null_gain = 0.0;          // the most that a replicate of the null gives
  double share = 0.0;              // (gain - null) over the residual's energy, at least 0
  double best_regime_share = 0.0;  // the same within the regime where it is largest
  std::string best_regime;
  double typical_gain = 0.0;      // what its typical size would gain: below the null's, it cannot be seen
  double kept = 0.0;              // share of its signal that no base parameter can imitate
  std::string closest_parameter;  // the base parameter that imitates it best
  EffectUse start;
  std::vector<Unknown> base_unknowns;  // and where they go when the effect is added:
  std::vector<double> base_start;
  Eigen::VectorXd signal;  // projected, at its best size: for twins
  bool tried = false;      // false: interrupted, or every size of it made the model diverge

  // The base parameter that these data cannot part it from, if its page names that as its twin; empty: none.
  std::string aliased_parameter() const;
};
inline constexpr double kAliasedFraction =
    0.01;  // of its signal: less is kept, and a base parameter imitates it

std::vector<Screened> screen(const ScreeningTask& task, const std::vector<const EffectEntry*>& effects);
// Details of effects that the model has.
std::vector<Screened> screen_extensions(const ScreeningTask& task);

}  // namespace omnihil
