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
  Eigen::VectorXd x;
  double cost = INFINITY;
  int iterations = 0;
  bool converged = false;
};

// `held`: index of an unknown that stays where it is; -1: none.
Descent descend(const FitProblem& problem, const Eigen::VectorXd& start, int iterations,
                const FitOptions& options, Eigen::Index held = -1);

// Gauss-Newton without damping, from where a descent ended, as far as the cost falls. Where the data know a
// sum (mass and payload) and only the priors its parts, the damping, a thousandth of the data's curvature, is
// far stiffer than the priors: a descent ends where it first meets the valley, and not at its lowest point.
Descent finish_undamped(const FitProblem& problem, Descent descent);

}  // namespace omnihil
