// The simulated null: what the sensors alone would leave as a residual if the fitted base model were true.
//
//   NullModel null = simulate_null(predictor, baseline.model, fit, holdout, extrapolation, {.seed = 1});
//   null.fit_noise[k];              // residual of replicate k, sample by sample
//   null.mean_square[0](k, kind);   // its size per use
//
// Every gain that an effect is credited with is held against the gain that the same search finds in these.
// Without it every recording is blamed on something. Cannot: know of disturbances that the sensors' own noise
// does not have; for those an addition must also matter, and hold on other runs.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

struct NullModel {
  std::vector<Eigen::VectorXd> fit_noise;
  std::array<Eigen::MatrixXd, kSplits> mean_square;  // [use](replicate, kind)

  int replicates() const { return static_cast<int>(fit_noise.size()); }
  // per kind: mean over the replicates; 0 where a use has no runs
  Eigen::VectorXd floor(Split split) const;
  // per kind: standard deviation over the replicates
  Eigen::VectorXd spread(Split split) const;
};

// What a model leaves of what a simulated world has measured, in the evidence's order; empty: not finite.
// `predicted`: by the model, for the recording's own inputs (a robot's model follows those of the world).
Eigen::VectorXd simulated_residual(const Predictor& simulated, const WhitenedResiduals& residuals,
                        const Candidate& model, const Eigen::VectorXd& predicted);

NullModel simulate_null(const Predictor& predictor, const Candidate& truth,
                        const std::array<WhitenedResiduals, kSplits>& splits, std::uint64_t seed,
                        int replicates, int jobs);

}  // namespace omnihil
