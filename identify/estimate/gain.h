// How much of the error energy an addition takes away, and how sure that is.
//
//   const Eigen::VectorXd weights = weights_for(holdout, null, parent, child);   // whitened residuals
//   SplitGain g = BlockBootstrap(holdout, 1).gain(parent, child, weights);
//   g.ratio;        // error energy of the child over the parent's, mean over the signals
//   g.worst;        // ratio that 95 % of the bootstrap's draws stay below
//
// Residuals are autocorrelated, so samples are no evidence one by one: blocks of half a second are drawn with
// replacement (Kuensch 1989, block bootstrap), the same draws for every candidate.
#pragma once
#include <cstdint>

#include "identify/estimate/null_model.h"
#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

struct SplitGain {
  double ratio = 1.0;
  double best = 1.0;   // 5 % of the draws are below
  double worst = 1.0;  // 95 % are below
  double floor = 1.0;  // share of the sensors' own noise in the reference's energy
};

class BlockBootstrap {
 public:
  BlockBootstrap(const WhitenedResiduals& residuals, std::uint64_t seed);
  bool empty() const { return counts_.rows() == 0; }
  int draws() const { return static_cast<int>(counts_.rows()); }
  // Per draw: energy of `residual` over that of `reference`, mean over the signals with these weights.
  Eigen::VectorXd ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                         const Eigen::VectorXd& weights) const;
  SplitGain gain(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                 const Eigen::VectorXd& weights) const;

 private:
  const WhitenedResiduals* residuals_;
  Eigen::MatrixXd counts_;  // [draw, block]
};

// Ratio of error energies, mean over the signals that the reference has, with these weights (empty: equal).
double energy_ratio(const WhitenedResiduals& residuals, const Eigen::VectorXd& reference,
                    const Eigen::VectorXd& residual, const Eigen::VectorXd& weights = {});
// What each signal counts for an addition: its share of error energy above the sensors' floor, so that a
// signal at its floor does not water down what another one shows. A signal that the addition leaves to the
// last digit as it was (a measured bus voltage drives the model: no friction changes it) says nothing of it
// and counts nothing.
Eigen::VectorXd weights_for(const WhitenedResiduals& residuals, const NullModel& null,
                            const Eigen::VectorXd& parent, const Eigen::VectorXd& child);
// sqrt of the mean over signals of mean((residual / noise)^2)
double pooled_error(const WhitenedResiduals& residuals, const ComparedChannels& channels,
                    const Eigen::VectorXd& residual);

// Share of the energy that is the sensors' own, mean over the signals with these weights; 1: nothing else is
// left.
double floor_share(const WhitenedResiduals& residuals, const NullModel& null, const Eigen::VectorXd& residual,
                   const Eigen::VectorXd& weights);

}  // namespace omnihil
