// Estimates of a fit with their uncertainty, as numbers and as sentences.
//
//   describe(problem, predictor, point, x, result);     // fills result.parameters, covariance, findings
//
// Posterior covariance: (J'J + priors)^-1, J weighted by residual size and autocorrelation time
// (fit_problem.h). data_sigma: without priors; infinite along directions that the data do not determine. An
// unknown counts as not identifiable where data_sigma is not below its prior sigma (flat prior: not below its
// own value or typical size). It is named with the unknowns that it is correlated with in the data's own
// covariance. Closed loops: a drive input that follows the measured speed with a constant gain is named. x:
// size p, in the unknowns' own units.
#pragma once
#include "identify/estimate/fit.h"
#include "identify/estimate/fit_problem.h"

namespace omnihil {

void describe(const FitProblem& problem, const Predictor& predictor, const FitPoint& point,
              const Eigen::VectorXd& x, FitResult& result);

}  // namespace omnihil
