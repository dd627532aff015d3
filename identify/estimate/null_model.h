// Parametric bootstrap of the null hypothesis "the fitted base model is true": residuals of recordings that
// are simulated with it, through the same sensors with their noise.
//
//   NullModel null = simulate_null(predictor, baseline.model, splits, seed, replicates, jobs);
//   null.fit_noise[k];                          // residual of replicate k on the training runs, size n
//   null.mean_square[kTraining](k, channel);    // its mean square
//
// The gain of an effect is compared with the gain that the same search finds in these replicates; without
// them every recording would have an effect to blame. Cannot: contain disturbances beyond the sensors' own
// noise; against those an addition must also be large, and hold on other runs. Shapes: K replicates, m
// channels, n samples of a split (whitened_residuals.h), whose units hold.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

struct NullModel {
  std::vector<Eigen::VectorXd> fit_noise;            // [replicate], size n of the training split each
  std::array<Eigen::MatrixXd, kSplits> mean_square;  // [split] K x m; zeros: no runs

  int replicates() const { return static_cast<int>(fit_noise.size()); }
  // Size m: mean over the replicates, the noise floor of each channel.
  Eigen::VectorXd floor(Split split) const;
  // Size m: standard deviation over the replicates.
  Eigen::VectorXd spread(Split split) const;
};

// Size n: residual of `model` against a simulated measurement, in the order of `residuals`; empty: not
// finite. `predicted`: size n, by the model on the recording's own inputs. Where the inputs include heading
// or position (a robot) they are those of the simulation, and the model is run again.
Eigen::VectorXd simulated_residual(const Predictor& simulated, const WhitenedResiduals& residuals,
                                   const Candidate& model, const Eigen::VectorXd& predicted);

NullModel simulate_null(const Predictor& predictor, const Candidate& truth,
                        const std::array<WhitenedResiduals, kSplits>& splits, std::uint64_t seed,
                        int replicates, int jobs);

}  // namespace omnihil
