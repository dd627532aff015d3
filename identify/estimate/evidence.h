// What standard rules of model selection say of one addition, from the whitened residuals of the model without it
// (parent) and with it (child):
//
//   const Evidence e = evidence_of(training, fit, validation, held_out, extra_parameters);
//   e.delta_bic < 0;                        // the Bayesian information criterion prefers the child
//   e.delta_elpd > 2 * e.delta_elpd_se;     // so does the log density that it predicts for held-out runs
//
// BIC: Schwarz, Ann. Stat. 6(2), 1978, with the effective sample size n / tau in place of n, tau the integrated
// autocorrelation time of the child's residual (Sokal 1997, window 5 tau). ELPD: expected log pointwise predictive
// density of held-out blocks and its standard error (Vehtari, Gelman, Gabry, Stat. Comput. 27, 2017), Gaussian with
// the variance that each model has on the fit runs.
// Limits: neither knows of the laws' forms, which are never exact: on records of any length they accept what imitates
// that (docs/diagnosis-statistics.md). So BIC is necessary for an addition, not sufficient (acceptance.h); the
// log density is printed, and does not decide.
#pragma once
#include <Eigen/Core>

#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

struct Evidence {
  double delta_bic = 0.0;      // child minus parent; negative: for the child
  double delta_elpd = 0.0;     // child minus parent, nat; positive: for the child. 0 without held-out runs
  double delta_elpd_se = 0.0;  // its standard error, from the scatter of the blocks
};

// Samples, at least 1: integrated autocorrelation time of one channel.
double autocorrelation_time(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual, int channel);

// One residual per split and model; an empty one (a run diverged) gives no evidence.
struct ResidualPair {
  const Eigen::VectorXd& parent;
  const Eigen::VectorXd& child;
};
Evidence evidence_of(const WhitenedResiduals& training, const ResidualPair& fit,
                     const WhitenedResiduals& validation, const ResidualPair& held_out, int extra_parameters);

}  // namespace omnihil
