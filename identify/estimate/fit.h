// Fits a model's unknown numbers to the runs of use "fit".
//
//   FitResult r = fit(predictor, candidate, unknowns_of(candidate), {.jobs = 2});
//   r.model;                       // with the estimates in it
//   r.parameters[0].sentence;      // "not determined by these data: trades against
//   motor.rotor_inertia_kg_m2"
//
// Minimises  sum over runs, signals, samples of ((y - m) / s)^2 / n_eff-weights  +  sum of priors: each
// signal is weighed by its noise (or, where the model is far off, by its residual's size, so that none
// drowns the others), within bounds, by Ceres' trust region with exact derivatives. Covariance from the
// Jacobian, inflated by the residuals' autocorrelation; parameters that trade against each other are named by
// the weakest directions of the information matrix and a profile along them.
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
  double data_sigma = 0.0;              // from the data alone; infinite: the data say nothing
  double prior_mean = 0.0;              // what the model file believed
  double prior_sigma = 0.0;             // 0: nothing
  double prior_deviation_sigmas = 0.0;  // (value - prior_mean) / prior_sigma
  bool at_bound = false;
  bool identifiable = true;
  bool unphysical = false;                   // a sign or size that no drive has
  std::vector<std::string> correlated_with;  // paths
  std::string sentence;                      // plain language; empty: nothing to say
};

struct FitOptions {
  int jobs = 1;
  int max_iterations = 30;
  int starts = 1;  // further starts are drawn from the priors
  std::uint64_t seed = 1;
  bool profile = false;          // walk along flat directions instead of trusting the covariance
  bool coarse = false;           // rough covariance only: for rankings
  bool finish_undamped = false;  // to the end of valleys that only the priors know (fit_descent.h)
  bool robust = false;  // large residuals pull linearly (fit_problem.h): for the last word on numbers
  std::function<bool()> stop{};  // true: give up early with what is known
};

struct FitResult {
  Candidate model;
  std::vector<Unknown> unknowns;  // as asked
  std::vector<ParameterEstimate> parameters;
  Eigen::MatrixXd covariance;
  double cost = 0.0;       // data and priors
  double data_cost = 0.0;  // sum of squares over the noise, fit runs
  int iterations = 0;
  bool converged = false;
  bool stopped = false;
  std::vector<std::string> findings;  // plain language: bounds, signs, trades
};

FitResult fit(const Predictor& predictor, const Candidate& candidate, const std::vector<Unknown>& unknowns,
              const FitOptions& options);

}  // namespace omnihil
