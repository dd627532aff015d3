// Does an addition earn its place: gains on other runs than those it was fitted to, held against chance.
//
//   const AcceptanceResult j = judge(context, parent, child, "cogging", signal_to_null);
//   if (!j.accepted) say(j.why);    // "it takes 1.2 % of the held-out error energy; 3.5 % would matter"
#pragma once
#include <array>
#include <string>
#include <vector>

#include "identify/estimate/fit.h"
#include "identify/estimate/gain.h"
#include "identify/estimate/null_model.h"
#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

using Splits = std::array<WhitenedResiduals, kSplits>;
using Residuals = std::array<Eigen::VectorXd, kSplits>;

// A fitted model and what it leaves.
struct Fitted {
  FitResult fit;
  Residuals residual;                                 // whitened
  std::array<Eigen::VectorXd, kSplits> unweighted{};  // mean square per kind of signal, not whitened
  bool finite = false;                                // in every use
};
Fitted fitted(const Splits& splits, const Splits& unweighted, FitResult fit, int jobs);

struct AcceptanceResult {
  bool accepted = false;
  bool decisive = false;  // it takes so much that no further question decides
  bool by_prior = false;  // accepted for what it lets come back, not for its gain
  std::string why;
  SplitGain fit, holdout, extrapolation;
};

struct AcceptanceContext {
  const Splits* splits = nullptr;
  const NullModel* null = nullptr;
  std::array<const BlockBootstrap*, kSplits> bootstrap{};
  double rate_Hz = 0.0;  // of the samples; 0: not known
};

// `signal_to_null`: the screening's gain over what the simulated null's replicates gave; `aliased_parameter`: the
// base parameter that data cannot part it from (screening.h).
AcceptanceResult test_acceptance(const AcceptanceContext& context, const Fitted& parent, const Fitted& child,
                                 const std::string& name, double signal_to_null,
                                 std::string_view aliased_parameter = {});

}  // namespace omnihil
