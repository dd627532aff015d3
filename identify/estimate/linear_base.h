// The fitted base model, made linear: what a further signal would gain once the base parameters have moved
// along.
//
//   LinearBase base(fit_evidence, model, unknowns, scales, jobs);
//   LinearGain g = base.gain(difference_signals, one_sided, base.residual());
//   g.gain;   // by how much the weighted sum of squares (with priors) falls
//
// Law: minimise |r - J d - D a|^2 + priors(x + d) over d and a; a from the Schur complement
//   (D'D - D'J A^-1 J'D) a = D'r - D'J A^-1 g,   A = J'J + L,   g = J'r - L (x - m)
// with J the derivatives after base parameters, L the priors' inverse variances times the residual's
// autocorrelation time (neighbouring samples say the same thing). Source: Golub, Pereyra 1973 (separable
// least squares). One-sided columns (a friction cannot be negative) are kept at or above zero by trying every
// subset. Validity: small changes; what is found here is refitted in full.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

struct LinearGain {
  double gain = 0.0;
  std::vector<double> coefficients;  // of the columns
  Eigen::VectorXd base_shift;        // of the unknowns
};

// Columns as the base sees them.
struct ProjectedColumns {
  Eigen::MatrixXd columns;   // what is left of them beside the base's derivatives
  Eigen::MatrixXd gram;      // Schur complement
  Eigen::MatrixXd coupling;  // A^-1 J'D
  double kept = 0.0;         // share of their energy that is left
};

class LinearBase {
 public:
  LinearBase(const WhitenedResiduals& residuals, const Candidate& model, const std::vector<Unknown>& unknowns,
             const Eigen::VectorXd& scale_of_channel, int jobs);

  bool usable() const { return usable_; }
  const Eigen::VectorXd& residual() const { return residual_; }  // weighted
  const Eigen::VectorXd& weights() const { return weights_; }
  const Eigen::VectorXd& prediction() const { return prediction_; }  // as predicted, not weighted
  double energy() const { return residual_.squaredNorm(); }
  double autocorrelation_samples() const { return autocorrelation_; }
  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  const Eigen::MatrixXd& derivatives() const { return jacobian_; }  // weighted

  ProjectedColumns project(Eigen::MatrixXd weighted_columns) const;
  LinearGain gain(const ProjectedColumns& columns, const std::vector<bool>& two_sided) const;
  // The same with every column as it is: of a law whose signal does not grow in proportion to its strength.
  LinearGain gain_as_tried(const ProjectedColumns& columns) const;
  // What chance would have gained: `noise` weighted, in place of the residual.
  double gain_in_noise(const ProjectedColumns& columns, const std::vector<bool>& two_sided,
                       const Eigen::VectorXd& noise) const;

 private:
  Eigen::VectorXd correlation(const ProjectedColumns& columns) const;
  Eigen::VectorXd base_shift(const ProjectedColumns& columns, const Eigen::VectorXd& coefficients) const;

  bool usable_ = false;
  std::vector<Unknown> unknowns_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd prediction_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd jacobian_;
  Eigen::VectorXd prior_;     // L
  Eigen::VectorXd gradient_;  // g
  Eigen::LLT<Eigen::MatrixXd> normal_;
  double autocorrelation_ = 1.0;
};

// Greatest b'a of G a = b with a >= 0 where a column is one-sided. {gain, a}
std::pair<double, Eigen::VectorXd> bounded_gain(const Eigen::MatrixXd& gram,
                                                const Eigen::VectorXd& correlation,
                                                const std::vector<bool>& two_sided);

// How many samples of a residual say one thing: 1 + 2 sum of autocorrelations until they fade.
double autocorrelation_samples(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual);

}  // namespace omnihil
