// Every effect that applies, scored in one pass: what it would gain if it were added to the fitted model.
//
//   const ScreeningTask screening{.residuals = &residuals, .model = &model, .base = &linear};
//   std::vector<Screened> s = screen(screening, effects);  // in the order of `effects`
//   s[0].share;          // of the residual's energy that it would remove, that of the null subtracted
//   s[0].start;          // the effect with parameters to start a refit from
//
// Per effect: difference signals (the model with the effect less the model without it) at a few shapes and
// sizes; the base parameters' derivatives are projected out (linear_base.h) and the residual is regressed on
// what remains, over all samples and over each regime alone (slow, steady, transient, fast), since an effect
// may show in one only. The same regression on the simulated null's residuals gives the gain that is expected
// by chance.
// Limits: linear in the strengths about the sizes tried; the shortlist is refitted in full.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "identify/estimate/linear_base.h"
#include "identify/estimate/null_model.h"
#include "identify/select/angle_resolution.h"
#include "identify/select/effect_variants.h"

namespace omnihil {

// Share of its signal in rows too far apart to know the angle (angle_resolution.h), from which a law of the angle is
// not told from one of the mean: most of it. A choice.
inline constexpr double kMostUnresolved = 0.5;  // a choice

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
  const Candidate* at_priors =
      nullptr;  // `model`, the base parameters at their priors; null: not tried from there
  std::vector<Eigen::VectorXd> noise;  // weighted residuals of the null: [replicate], one value per sample
  std::vector<RegimeMask> regimes;
  DataScale scale;
  AngleDrift drift{};  // empty: not looked at
  int jobs = 1;
  std::function<bool(double share)> progress;  // false: give up
};

struct Screened {
  const EffectEntry* entry = nullptr;
  std::string name;          // of the effect
  bool extends = false;      // further strengths of an effect that is there already
  double gain = 0.0;         // fall of the weighted sum of squares
  double null_gain = 0.0;    // largest of the null's replicates
  double share = 0.0;        // (gain - null_gain) over the residual's energy, at least 0
  double prior_share = 0.0;  // part of it that base parameters nearer their priors make: no residual shows it
  double best_regime_share = 0.0;  // the same within the regime where it is largest
  std::string best_regime;
  double typical_gain = 0.0;  // at its typical size: below the null's, it is not visible
  // 1 - R^2 of its signal regressed on the base parameters' derivatives.
  double residual_fraction = 0.0;
  std::string closest_parameter;  // the base parameter that takes the largest part in that regression
  EffectUse start;
  std::vector<Unknown> base_unknowns;  // and their linear estimates beside the effect:
  std::vector<double> base_start;
  Eigen::VectorXd signal;   // at its best size, base parameters projected out: one value per sample
  Eigen::MatrixXd columns;  // of which that is the sum: one per strength, in their channels' whitened units
  std::vector<bool> two_sided;
  double unresolved = 0.0;  // share of that in rows too far apart to know a law's angle (angle_resolution.h)
  // false: interrupted, every size of it made the model diverge, or no row knows its angle
  bool tried = false;

  // Of the residual's energy, what of `share` a refit can show.
  double data_share() const { return share - prior_share; }

  // Is a law of the angle told from one of the mean? True of others.
  bool is_resolved() const { return unresolved <= kMostUnresolved; }

  // The base parameter that is aliased with it in these data, if its page lists that as easily confused;
  // empty: none.
  std::string aliased_parameter() const;
};
// Residual fraction below which an effect and a base parameter are aliased. Tuned on the open cases
// (DECISIONS 56); sensitivity not measured.
inline constexpr double kAliasedFraction = 0.01;  // tuned

std::vector<Screened> screen(const ScreeningTask& task, const std::vector<const EffectEntry*>& effects);
// Details of effects that the model has.
std::vector<Screened> screen_extensions(const ScreeningTask& task);

}  // namespace omnihil
