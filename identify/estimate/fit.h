// Maximum a posteriori fit of a model's unknown parameters to the training runs.
//
//   FitResult r = fit(predictor, candidate, unknowns_of(candidate), {.jobs = 2});
//   r.model;                       // with the estimates in it
//   r.parameters[0].sentence;      // "not determined by these data: trades against motor.slots"
//
// Minimises  sum over runs, signals, samples of ((y - m) / s)^2 / t  +  sum over unknowns of ((x - m_p) /
// s_p)^2 (fit_problem.h: s a signal's scale, t its residual's autocorrelation time), within bounds, by Ceres'
// trust region with exact derivatives. Covariance from the Jacobian; weakly identifiable parameters are named
// by the directions of small eigenvalues of the information matrix, and profiled along them. p unknowns, in
// their own units.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

struct ParameterEstimate {
  std::string path;
  std::string unit;
  double value = 0.0;
  double sigma = 0.0;                   // posterior, 1-sigma
  double data_sigma = 0.0;              // from the data alone; infinite: not determined by them
  double prior_mean = 0.0;              // of the model file
  double prior_sigma = 0.0;             // tolerance * prior_mean; 0: flat
  double prior_deviation_sigmas = 0.0;  // of the value, by its prior's form (prior.h)
  bool at_bound = false;
  bool identifiable = true;
  bool unphysical = false;                   // pressed against a bound of 0: negative friction and the like
  std::vector<std::string> correlated_with;  // paths, where not identifiable; strongest first
  std::string sentence;                      // for a user; empty: none
  PriorForm prior_form = PriorForm::kNormal;
};

struct FitOptions {
  int jobs = 1;
  int max_iterations = 30;
  int starts = 1;  // further starts are drawn from the priors
  std::uint64_t seed = 1;
  bool profile = false;          // profile likelihood of weakly identifiable parameters (fit_profile.h)
  bool coarse = false;           // looser convergence (fit_descent.cc): for rankings
  bool finish_undamped = false;  // along directions that only the priors determine (fit_descent.h)
  bool robust = false;           // Huber's loss at 1.345 sigma (fit_problem.h): for the reported estimates
  std::function<bool()> stop{};  // true: end early with the best so far
};

struct FitResult {
  Candidate model;
  std::vector<Unknown> unknowns;  // as asked
  std::vector<ParameterEstimate> parameters;
  Eigen::MatrixXd covariance;  // p x p, posterior, in the products of the unknowns' units
  double cost = 0.0;           // data and priors
  double data_cost = 0.0;      // sum of squares over the noise, training runs
  int iterations = 0;
  bool converged = false;
  bool stopped = false;
  std::vector<std::string> findings;  // plain language: bounds, signs, correlations
};

FitResult fit(const Predictor& predictor, const Candidate& candidate, const std::vector<Unknown>& unknowns,
              const FitOptions& options);

}  // namespace omnihil
