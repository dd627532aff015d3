// The cost function of a fit at one point: value, gradient and Gauss-Newton matrix, all training runs
// together.
//
//   FitProblem problem(predictor, candidate, unknowns, jobs);
//   problem.reweigh(x);                        // sizes and autocorrelation of the residuals at x
//   FitPoint p = problem.at(x, true);          // p.cost(), p.gradient, p.information (data alone)
//
// Law: cost = 1/2 sum over signals c, samples i of rho(r_ci^2 / s_c^2) / t_c + 1/2 sum over unknowns of ((x -
// m_p) / s_p)^2, r whitened (predictor.h). s_c: the larger of the signal's noise and its residual's rms, so
// that no signal dominates the others where the model is far off; t_c: the residual's autocorrelation time in
// samples, so that data count as many independent samples as they hold, beside the priors. rho: Huber's,
// linear beyond 6 s_c: a rare glitch has bounded influence, and samples of a model that is merely wrong stay
// quadratic. `robust`: linear beyond 1.345 s_c, s_c by the median, so that a run whose conditions are known
// wrongly does not bias the estimates; 95 % as efficient as least squares where the residual is Gaussian. p
// unknowns: x, gradient of size p, information of p x p, in the unknowns' own units and their inverses.
// Derivatives are made once for a point, however often it is weighed. `near_enough`: and taken for those of points nearby, a
// tenth of each unknown's scale off at most, where a record is costly (of wheels on a floor): Gauss-Newton with them ends where
// it would, in more steps that cost a simulation each.
// Sources: Huber 1964; Holland, Welsch 1977 (1.345); Sokal 1997 (autocorrelation time).
#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>

#include "identify/predict/predictor.h"
#include "identify/record/remembered.h"

namespace omnihil {

struct FitPoint {
  bool finite = false;
  double data_cost = 0.0;  // half the weighted sum of squares
  double prior_cost = 0.0;
  Eigen::VectorXd gradient;     // size p, of data and priors; empty without derivatives
  Eigen::MatrixXd information;  // p x p: J' J of the data alone, weighted
  double cost() const { return data_cost + prior_cost; }
};

struct SignalWeight {
  double size = 1.0;             // s_c, in the whitened signal's unit
  double autocorrelation = 1.0;  // t_c, in samples
  double samples = 0.0;
};

class FitProblem {
 public:
  FitProblem(const Predictor& predictor, const Candidate& candidate, const std::vector<Unknown>& unknowns,
             int jobs, bool robust = false, bool near_enough = false);

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  bool empty() const { return runs_.empty(); }
  // The same problem with the same weights, for another thread; every point has derivatives of its own.
  std::unique_ptr<FitProblem> beside() const;
  Candidate candidate_at(const Eigen::VectorXd& x) const;

  // Sets s_c and t_c from the residuals at x; false where the model is not finite there.
  bool reweigh(const Eigen::VectorXd& x);
  const std::map<std::string, SignalWeight>& weights() const { return weights_; }

  FitPoint at(const Eigen::VectorXd& x, bool derivatives) const;
  // With the derivatives by one unknown alone: gradient and information are of size 1.
  FitPoint along(const Eigen::VectorXd& x, Eigen::Index unknown) const;
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
  std::shared_ptr<const std::vector<Prediction>> predicted(const Eigen::VectorXd& x) const;
  FitPoint evaluated(const Eigen::VectorXd& x, std::span<const Unknown> by, Eigen::Index first) const;
  std::vector<Prediction> derived(const Eigen::VectorXd& x, std::span<const Unknown> by) const;
  bool near_derived(const Eigen::VectorXd& x) const;
  RunPart part(int run, const Prediction& values, const std::vector<const Prediction*>& strides,
               Eigen::Index n) const;

  const Predictor& predictor_;
  Candidate candidate_;
  std::vector<Unknown> unknowns_;
  int jobs_ = 1;
  bool robust_ = false, near_enough_ = false;
  std::vector<int> runs_;
  std::vector<std::size_t> longest_first_;  // indices into runs_: what is begun last is not what all wait for
  std::map<std::string, SignalWeight> weights_;
  // The last predictions without derivatives, as runs_: the start, the best point so far, the end of the last step and one trial
  // are asked for again with other weights, more are not.
  static constexpr std::size_t kKept = 4;  // derived from what fit() asks
  mutable Remembered<Eigen::VectorXd, std::vector<Prediction>> predicted_{kKept};
  // The last ones by all unknowns, a run's passes one after another. One thread at a time may ask.
  struct Derived {
    Eigen::VectorXd x;
    std::vector<Prediction> runs;
  };
  mutable Derived derived_;
};

}  // namespace omnihil
