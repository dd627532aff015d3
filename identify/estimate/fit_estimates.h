// What a fit has found about each unknown, with its uncertainty, in numbers and in words.
//
//   describe(problem, predictor, point, x, nominal_unknowns, result);
//
// Posterior covariance: (J'J + priors)^-1, J weighted by residual size and autocorrelation time
// (fit_problem.h). data_sigma: the same without priors; infinite along directions in which the data say
// nothing. An unknown counts as not identifiable where the data alone leave more than its prior does (without
// a prior: more than its own value or typical size). What it trades against: the other members of the weakest
// direction of the data's information that it is part of. Closed loops: a drive input that follows the
// measured speed with a constant gain is named.
#pragma once
#include "identify/estimate/fit.h"
#include "identify/estimate/fit_problem.h"

namespace omnihil {

void describe(const FitProblem& problem, const Predictor& predictor, const FitPoint& point,
              const Eigen::VectorXd& x, FitResult& result);

}  // namespace omnihil
