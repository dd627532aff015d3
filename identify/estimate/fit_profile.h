// Profile likelihood where the covariance cannot be trusted: one unknown is fixed at a distance, all others
// are refitted, and the rise of the cost gives its sigma.
//
//   profile(problem, x, options, result);      // corrects result.parameters
//
// For the unknowns that stand at a bound or that the data determine weakly (at most four, the weakest first):
// fixed at one sigma to either side, the others refitted. Twice the rise of the cost is the squared distance
// in sigmas (Venzon, Moolgavkar 1988); less than 0.1 to both sides is "not determined". Cannot: see further
// local minima. x: size p, the optimum, in the unknowns' own units.
#pragma once
#include "identify/estimate/fit_descent.h"

namespace omnihil {

void profile(const FitProblem& problem, const Eigen::VectorXd& x, const FitOptions& options,
             FitResult& result);

}  // namespace omnihil
