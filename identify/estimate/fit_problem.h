// What a fit minimises, at one point: value, gradient and Gauss-Newton matrix, all fit runs together.
//
//   FitProblem problem(predictor, candidate, unknowns, jobs);
//   problem.reweigh(x);                        // sizes and autocorrelation of the residuals at x
//   FitPoint p = problem.at(x, true);          // p.cost, p.gradient, p.information (data), with priors apart
//
// Law: cost = 1/2 sum over signals c, samples i of rho(r_ci^2 / s_c^2) / t_c + 1/2 sum over unknowns of ((x -
// m) / p)^2, r whitened (predictor.h). s_c: the larger of the signal's noise and its residual's size, so that
// no signal drowns the others where the model is far off; t_c: the residual's autocorrelation time in
// samples, so that data and priors are weighed as what they tell. rho: Huber's, linear beyond six sizes: a
// rare glitch pulls with bounded force, and no sample of a model that is merely wrong is touched. `robust`:
// linear beyond 1.345 sizes, sizes by the median, so that a run whose conditions are known wrongly does not
// bend the numbers of all others; 95 % as efficient as least squares where the residual is Gaussian. Sources:
// Huber 1964; Holland, Welsch 1977 (1.345); Sokal 1997 (autocorrelation time).
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>

#include "identify/predict/predictor.h"

namespace omnihil {

struct FitPoint {
  bool finite = false;
  double data_cost = 0.0;  // half the weighted sum of squares
  double prior_cost = 0.0;
  Eigen::VectorXd gradient;     // of both
  Eigen::MatrixXd information;  // J' J of the data alone, weighted
  double cost() const { return data_cost + prior_cost; }
};

struct SignalWeight {
  double size = 1.0;             // s_c
  double autocorrelation = 1.0;  // t_c
  double samples = 0.0;
};

class FitProblem {
 public:
  FitProblem(const Predictor& predictor, const Candidate& candidate, const std::vector<Unknown>& unknowns,
             int jobs, bool robust = false);

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  bool empty() const { return runs_.empty(); }
  Candidate candidate_at(const Eigen::VectorXd& x) const;

  // Sizes and autocorrelation at x; false where the model is not finite there.
  bool reweigh(const Eigen::VectorXd& x);
  const std::map<std::string, SignalWeight>& weights() const { return weights_; }

  FitPoint at(const Eigen::VectorXd& x, bool derivatives) const;
  // Sum of squares over the noise alone, as FitResult::data_cost has it.
  double noise_cost(const Eigen::VectorXd& x) const;

 private:
  struct RunPart {
    bool finite = true;
    double cost = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd information;
  };
  std::vector<std::vector<Eigen::VectorXd>> residuals(const Eigen::VectorXd& x, bool& finite) const;
  RunPart part(int run, const Prediction& values, const std::vector<const Prediction*>& strides) const;

  const Predictor& predictor_;
  Candidate candidate_;
  std::vector<Unknown> unknowns_;
  int jobs_ = 1;
  bool robust_ = false;
  std::vector<int> runs_;
  std::map<std::string, SignalWeight> weights_;
};

}  // namespace omnihil
