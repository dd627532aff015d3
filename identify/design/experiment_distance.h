// How far apart two models are on a record, after one of them has been refitted to the other.
//
//   Distance d = refitted_distance(simulated, runs, truth, rival, variances, 3);
//   d.sigmas;                          // sqrt of the remaining sum of squares, in sigmas of the noise
//
// Law: min over x of  sum (y_truth - y(x))^2 / (s^2 t)  +  (x - c)' P (x - c),  within the unknowns' bounds,
// by Gauss and Newton from x = c. Residuals are whitened (predictor.h); s and t: rms and autocorrelation time
// of the fitted model's residual in the given data (fit_problem.h), s at least the noise. p unknowns: x, c of
// size p in the unknowns' own units, P of p x p in their inverse products. With no iteration the refit is
// linear, from the derivatives at c: for ranking many runs.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

// A model with the information on its parameters: of priors, and of data it was fitted to.
struct HeldModel {
  Candidate model;
  std::vector<Unknown> unknowns;  // p
  Eigen::VectorXd center;         // c: size p, values of the unknowns
  Eigen::MatrixXd hold;           // P: p x p
};

// s^2 t by signal, in the signal's unit squared.
using SignalVariances = std::map<std::string, double>;

struct Distance {
  double sigmas = 0.0;
  bool finite = true;
};

// `simulated`: gives inputs, clock and sensors of `runs`; its measurement is not used, but for where it is
// missing.
Distance refitted_distance(const Predictor& simulated, const std::vector<int>& runs, const Candidate& truth,
                           const HeldModel& rival, const SignalVariances& variances, int iterations);

// J' J of the model on simulated runs, p x p: the information that they would give on the unknowns.
Eigen::MatrixXd information_of(const Predictor& simulated, const std::vector<int>& runs,
                               const HeldModel& model, const SignalVariances& variances);

// p x p: 1 / prior_sigma^2 on the diagonal, 0 for a flat prior.
Eigen::MatrixXd prior_hold(const std::vector<Unknown>& unknowns);

// sqrt of one unknown's entry in the inverse of a p x p information matrix; infinite where that is singular
// in it.
double sigma_of(const Eigen::MatrixXd& information, Eigen::Index unknown);

}  // namespace omnihil
