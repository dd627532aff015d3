// One descent of a fit from one start: Ceres' trust region (Levenberg-Marquardt, dense QR) within bounds, on
// a problem condensed to as many residuals as unknowns (Agarwal, Mierle and others, ceres-solver.org).
//
//   Descent d = descend(problem, start, 30, options);
//   d.x; d.cost;                  // never above the start's
#pragma once
#include <cmath>

#include "identify/estimate/fit.h"
#include "identify/estimate/fit_problem.h"

namespace omnihil {

struct Descent {
  Eigen::VectorXd x;  // size p, in the unknowns' own units
  double cost = INFINITY;
  int iterations = 0;
  bool converged = false;
};

// start: size p, in the unknowns' own units. `held`: index of an unknown that stays fixed; -1: none.
Descent descend(const FitProblem& problem, const Eigen::VectorXd& start, int iterations,
                const FitOptions& options, Eigen::Index held = -1);

// Gauss-Newton without damping from the end of a descent, as long as the cost falls. Along a weakly
// identifiable direction (data determine a sum, as of mass and payload, and only the priors its parts)
// Levenberg and Marquardt's damping, 1e-3 of the data's curvature (1 over the initial trust region radius),
// exceeds the priors' curvature, so that a descent stops short of the optimum (DECISIONS 56).
Descent finish_undamped(const FitProblem& problem, Descent descent);

}  // namespace omnihil
