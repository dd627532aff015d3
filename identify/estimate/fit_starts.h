// Starting points of a fit, beyond the values it is given.
//
//   std::vector<Eigen::VectorXd> starts = fit_starts(problem, given, drawn, seed);   // the first: given
//
// Each of size p, in the unknowns' own units.
// An effect whose strengths all stand at neutral gets a second start: its shapes where a small strength would
// help most (phases from the gradients at 0 and pi/2, speeds and widths on a grid of a factor of five), its
// strength by the Gauss-Newton step, or, where the gradient at neutral is zero (a play, a limit that
// does not act yet), the best of a few sizes. Further starts are drawn from the priors. Deterministic for a
// seed.
#pragma once
#include <cstdint>
#include <vector>

#include "identify/estimate/fit_problem.h"

namespace omnihil {

std::vector<Eigen::VectorXd> fit_starts(const FitProblem& problem, const Eigen::VectorXd& given, int drawn,
                                        std::uint64_t seed);

Eigen::VectorXd within_bounds(const std::vector<Unknown>& unknowns, Eigen::VectorXd x);

}  // namespace omnihil
