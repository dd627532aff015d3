// The acceptance test of one addition: is its gain on runs that it was not fitted to real, large enough and
// physically plausible?
//
//   const AcceptanceResult result = test_acceptance(context, parent, child, "cogging", signal_to_null);
//   result.accepted();  result.why;
//   // "it removes 1.2 % of the held-out error energy; 3.5 % is required"
//
// Method: parent and child are compared by the ratio of their whitened residual energies on each split, its
// interval from a block bootstrap (gain.h) and its level from the simulated null (null_model.h). Ten gates,
// in the order of test_acceptance; the first one that fails is the reason. The last one is the Bayesian information
// criterion (evidence.h): a gain has to pay for its numbers. Beside them one way without gain: AcceptedBy::kPrior
// (plausibility.h).
// Limits: the gates' sizes are tuned, not derived from one error rate; each says so at its line.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "identify/estimate/evidence.h"
#include "identify/estimate/fit.h"
#include "identify/estimate/gain.h"
#include "identify/estimate/null_model.h"
#include "identify/select/plausibility.h"
#include "identify/select/ranked_effect.h"

namespace omnihil {

using Splits = std::array<WhitenedResiduals, kSplits>;
using Residuals = std::array<Eigen::VectorXd, kSplits>;

// A fitted model and its residuals.
struct Fitted {
  FitResult fit;
  Residuals residual;                                 // whitened, one per sample of the split
  std::array<Eigen::VectorXd, kSplits> unweighted{};  // mean square per channel in its own units, squared
  bool finite = false;                                // in every split
};
Fitted fitted(const Splits& splits, const Splits& unweighted, FitResult fit, int jobs);

// The least gain on the runs that an addition was fitted to, of their error energy: half of the smallest gain of interest.
inline constexpr double kLeastFitGain = 0.015;  // tuned (acceptance.cc)

struct AcceptanceResult {
  AcceptedBy accepted_by = AcceptedBy::kNone;
  bool decisive = false;  // its gain alone proves the strength: no significance test of that
  std::string why;        // for people
  SplitGain fit, holdout, extrapolation;
  bool plausible = true;  // its numbers and those of the base (plausibility.h)
  // Of the base model's energy above the noise, on the runs that decide: what the addition removes.
  double share_of_base = 1.0;
  bool negligible = false;  // it moves every signal by less than their scales are known
  Evidence evidence;        // what standard rules of selection say of it

  bool accepted() const { return accepted_by != AcceptedBy::kNone; }
  // For a reason that no gate has; empty: none.
  void refuse(std::string reason) {
    if (reason.empty()) return;
    accepted_by = AcceptedBy::kNone;
    plausible = false;
    why = std::move(reason);
  }
};

struct AcceptanceContext {
  const Splits* splits = nullptr;
  const NullModel* null = nullptr;
  const ComparedChannels* channels = nullptr;
  std::array<const BlockBootstrap*, kSplits> bootstrap{};
  Resolution resolution{};
  // Beside the parent (verdict.h): the least sizes of gains are waived for what explains nearly all of it.
  bool structure_remains = false;
  // Whitened residuals of the base model, before any effect was found; null: the parent is that.
  const Residuals* base = nullptr;
  const FitResult* base_fit = nullptr;  // that model's: its effects are declared, not found; null: none is
  // Of the measured signals, per channel in its unit squared; empty: not known.
  std::array<Eigen::VectorXd, kSplits> signal_variance{};
};

// Of one model against another of `extra_parameters` fewer numbers (negative: more), on the context's runs.
Evidence evidence_of(const AcceptanceContext& context, const Fitted& parent, const Fitted& child,
                     int extra_parameters);

// Do two laws change the same quantity by the same kind of argument? Supply and bridge both make the mean voltage at the winding. What
// repeats itself with an angle is no form of what does not.
bool is_kin(const EffectInfo& a, const EffectInfo& b);

// As `signal_to_null`: that gain was tested before, or there is no screening to test it by. A marker, above any threshold.
inline constexpr double kScreenedBefore = 1e9;  // a choice

// `signal_to_null`: the screening's gain over the largest gain in the simulated null's replicates;
// `aliased_parameter`: the base parameter that these data cannot separate from the effect (screening.h).
AcceptanceResult test_acceptance(const AcceptanceContext& context, const Fitted& parent, const Fitted& child,
                                 const std::string& name, double signal_to_null,
                                 std::string_view aliased_parameter = {});

}  // namespace omnihil
