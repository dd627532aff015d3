// Does an addition earn its place: gains on other runs than those it was fitted to, held against chance.
//
//   UseGain g = gain_over(holdout, parent_residual, child_residual, {.seed = 1});
//   g.ratio;        // error energy of the child over the parent's, mean over the signals
//   g.worst;        // ratio that 95 % of the bootstrap's draws stay below
//
// Residuals are autocorrelated, so samples are no evidence one by one: blocks of half a second are drawn with
// replacement (Kuensch 1989, block bootstrap), the same draws for every candidate.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/identify/evidence.h"
#include "sim/identify/fit.h"
#include "sim/identify/null_model.h"

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

struct UseGain {
  double ratio = 1.0;
  double best = 1.0;   // 5 % of the draws are below
  double worst = 1.0;  // 95 % are below
  double floor = 1.0;  // share of the sensors' own noise in the reference's energy
};

class BlockBootstrap {
 public:
  BlockBootstrap(const Evidence& evidence, std::uint64_t seed);
  bool empty() const { return counts_.rows() == 0; }
  int draws() const { return static_cast<int>(counts_.rows()); }
  // Per draw: energy of `residual` over that of `reference`, mean over the signals with these weights.
  Eigen::VectorXd ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                         const Eigen::VectorXd& weights) const;
  UseGain gain(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
               const Eigen::VectorXd& weights) const;

 private:
  const Evidence* evidence_;
  Eigen::MatrixXd counts_;  // [draw, block]
};

// Ratio of error energies, mean over the signals that the reference has, with these weights (empty: equal).
double energy_ratio(const Evidence& evidence, const Eigen::VectorXd& reference,
                    const Eigen::VectorXd& residual, const Eigen::VectorXd& weights = {});
// What each signal counts: its share of error energy above the sensors' floor, so that a signal at its floor
// does not water down what another one shows. At least kFloorWeight.
Eigen::VectorXd signal_weights(const Evidence& evidence, const NullModel& null,
                               const Eigen::VectorXd& reference);
// The same, for an addition: a signal that it leaves to the last digit as it was (a measured bus voltage
// drives the model: no friction changes it) says nothing of it and counts nothing.
Eigen::VectorXd weights_for(const Evidence& evidence, const NullModel& null, const Eigen::VectorXd& parent,
                            const Eigen::VectorXd& child);
// sqrt of the mean over signals of mean((residual / noise)^2)
double pooled_error(const Evidence& evidence, const SignalKinds& kinds, const Eigen::VectorXd& residual);

struct Judgement {
  bool accepted = false;
  bool plain = false;  // it takes so much that no further question decides
  std::string why;
  UseGain fit, holdout, extrapolation;
};

struct JudgeContext {
  const Uses* uses = nullptr;
  const NullModel* null = nullptr;
  std::array<const BlockBootstrap*, kUses> bootstrap{};
};

// `null_gain_ratio`: the screening's gain over the most that chance gave (above 1: more than chance).
Judgement judge(const JudgeContext& context, const Fitted& parent, const Fitted& child,
                const std::string& name, double gain_over_chance);

// Share of the energy that is the sensors' own, mean over the signals with these weights; 1: nothing else is
// left.
double floor_share(const Evidence& evidence, const NullModel& null, const Eigen::VectorXd& residual,
                   const Eigen::VectorXd& weights);

}  // namespace omnihil
