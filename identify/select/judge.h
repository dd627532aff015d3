// Does an addition earn its place: gains on other runs than those it was fitted to, held against chance.
//
//   const Judgement j = judge(context, parent, child, "cogging", gain_over_chance);
//   if (!j.accepted) say(j.why);    // "it takes 1.2 % of the held-out error energy; 3.5 % would matter"
#pragma once
#include <array>
#include <string>
#include <vector>

#include "identify/estimate/evidence.h"
#include "identify/estimate/fit.h"
#include "identify/estimate/gain.h"
#include "identify/estimate/null_model.h"

namespace omnihil {

using Uses = std::array<Evidence, kUses>;
using Residuals = std::array<Eigen::VectorXd, kUses>;

// A fitted model and what it leaves.
struct Fitted {
  FitResult fit;
  Residuals residual;                            // whitened
  std::array<Eigen::VectorXd, kUses> as_seen{};  // mean square per kind of signal, not whitened
  bool finite = false;                           // in every use
};
Fitted fitted(const Uses& uses, const Uses& seen, FitResult fit, int jobs);

struct Judgement {
  bool accepted = false;
  bool plain = false;      // it takes so much that no further question decides
  bool by_belief = false;  // accepted for what it lets come back, not for its gain
  std::string why;
  UseGain fit, holdout, extrapolation;
};

struct JudgeContext {
  const Uses* uses = nullptr;
  const NullModel* null = nullptr;
  std::array<const BlockBootstrap*, kUses> bootstrap{};
  double rate_Hz = 0.0;  // of the samples; 0: not known
};

// `gain_over_chance`: the screening's gain over what the simulated null's replicates gave; `stands_for`: the
// base parameter that data cannot part it from (screening.h).
Judgement judge(const JudgeContext& context, const Fitted& parent, const Fitted& child,
                const std::string& name, double gain_over_chance, std::string_view stands_for = {});

}  // namespace omnihil
