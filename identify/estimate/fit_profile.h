// Intervals where the covariance cannot be trusted: one unknown is moved, all others follow, and the cost
// says how far the data and the priors let it go.
//
//   profile(problem, x, options, result);      // mends result.parameters
//
// For the unknowns that stand at a bound or that the data hardly know (at most four, the least known first):
// held at one sigma to either side, the others fitted again. Twice the rise of the cost is the squared
// distance in sigmas (profile likelihood; Venzon, Moolgavkar 1988); less than 0.1 to both sides is "not
// determined". Cannot: see second valleys.
#pragma once
#include "identify/estimate/fit_descent.h"

namespace omnihil {

void profile(const FitProblem& problem, const Eigen::VectorXd& x, const FitOptions& options,
             FitResult& result);

}  // namespace omnihil
