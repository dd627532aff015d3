// How far apart two models are on a record, after one of them has been refitted to the other.
//
//   Distance d = refitted_distance(world, runs, y_truth, rival, weights, held, 3);
//   d.sigmas;                          // sqrt of what is left, in sigmas of the noise
//
// Law: min over x of  sum (y_truth - y(x))^2 / (s^2 t)  +  (x - c)' P (x - c),  within the unknowns' bounds,
// by
//   Gauss and Newton from x = c. Residuals are whitened (predictor.h); s and t: size and autocorrelation of
//   what the fitted model leaves of the given data (fit_problem.h), at least the noise.
// With no iteration the refit is linear, from the derivatives at c: for ranking many runs.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

// A model and how firmly its numbers are held: by priors, and by data it was fitted to.
struct HeldModel {
  Candidate model;
  std::vector<Unknown> unknowns;
  Eigen::VectorXd center;  // values of the unknowns
  Eigen::MatrixXd hold;    // P
};

// s^2 t by signal.
using SignalVariances = std::map<std::string, double>;

struct Distance {
  double sigmas = 0.0;
  bool finite = true;
};

Distance refitted_distance(const Predictor& world, const std::vector<int>& runs, const Candidate& truth,
                           const HeldModel& rival, const SignalVariances& variances, int iterations);

// J' J of the rival on a world: what its runs would say of the unknowns.
Eigen::MatrixXd information_of(const Predictor& world, const std::vector<int>& runs, const HeldModel& model,
                               const SignalVariances& variances);

// 1 / sigma^2 on the diagonal, 0 where there is none.
Eigen::MatrixXd prior_hold(const std::vector<Unknown>& unknowns);

// sigma of one unknown under an information matrix; infinite where it says nothing.
double sigma_of(const Eigen::MatrixXd& information, Eigen::Index unknown);

}  // namespace omnihil
