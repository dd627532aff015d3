// By how much an addition lowers the error energy (sum of squared whitened residuals), with a bootstrap
// interval.
//
//   const Eigen::VectorXd weights = weights_for(validation, null, parent, child);   // whitened residuals
//   SplitGain g = BlockBootstrap(validation, 1).gain(parent, child, weights);
//   g.ratio;        // error energy of the child over the parent's, mean over the signals
//   g.worst;        // ratio that 95 % of the bootstrap's draws stay below
//
// Residuals are autocorrelated, so samples are not independent: blocks of half a second are drawn with
// replacement (Kuensch 1989, block bootstrap), the same draws for every candidate.
// Shapes: n samples, m channels, B blocks (whitened_residuals.h), D draws. Residuals: size n; weights: size
// m, of no unit; ratios of energies have none either.
#pragma once
#include <cstdint>

#include "identify/estimate/null_model.h"
#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

struct SplitGain {
  double ratio = 1.0;
  double best = 1.0;   // 5 % of the draws are below
  double worst = 1.0;  // 95 % are below
  double floor = 1.0;  // share of the sensors' noise (the null's floor) in the reference's energy
};

class BlockBootstrap {
 public:
  BlockBootstrap(const WhitenedResiduals& residuals, std::uint64_t seed);
  bool empty() const { return counts_.rows() == 0; }
  int draws() const { return static_cast<int>(counts_.rows()); }
  // Size D: energy of `residual` over that of `reference` per draw, weighted mean over the channels.
  Eigen::VectorXd ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                         const Eigen::VectorXd& weights) const;
  SplitGain gain(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                 const Eigen::VectorXd& weights) const;

 private:
  const WhitenedResiduals* residuals_;
  Eigen::MatrixXd counts_;  // D x B: how often a draw has a block
};

// Ratio of error energies, weighted mean over the channels that the reference has (empty weights: equal).
double energy_ratio(const WhitenedResiduals& residuals, const Eigen::VectorXd& reference,
                    const Eigen::VectorXd& residual, const Eigen::VectorXd& weights = {});
// Size m: weight of each channel for an addition: its share of error energy above the null's floor, so that a
// channel at its floor does not dilute the gain in another one. A channel whose residual the addition does
// not change (a measured bus voltage is the model's input: no friction changes it) has weight 0 (DECISIONS
// 43).
Eigen::VectorXd weights_for(const WhitenedResiduals& residuals, const NullModel& null,
                            const Eigen::VectorXd& parent, const Eigen::VectorXd& child);
// sqrt of the mean over channels of mean((residual / noise)^2); 1: at the stated noise.
double pooled_error(const WhitenedResiduals& residuals, const ComparedChannels& channels,
                    const Eigen::VectorXd& residual);

// Share of the sensors' noise (the null's floor) in the residual's energy, weighted mean over the channels;
// 1: the residual is at the floor.
double floor_share(const WhitenedResiduals& residuals, const NullModel& null, const Eigen::VectorXd& residual,
                   const Eigen::VectorXd& weights);

}  // namespace omnihil
