// The fitted base model, linearised: the gain of further columns (signals that an effect would add) with the
// base parameters refitted beside them.
//
//   LinearBase base(residuals, model, unknowns, scale_of_channel, jobs);
//   LinearGain g = base.gain(base.project(weighted_columns), two_sided);
//   g.gain;        // by how much the weighted sum of squares (with priors) falls
//   g.data_gain;   // by how much without them: all that a refit can show in the residual
//
// Law: minimise |r - J d - D a|^2 + priors(x + d) over d and a; a from the Schur complement
//   (D'D - D'J A^-1 J'D) a = D'r - D'J A^-1 g,   A = J'J + L,   g = J'r - L (x - m)
// with J the derivatives after base parameters, L the priors' inverse variances times the residual's
// autocorrelation time (neighbouring samples are not independent). Source: Golub, Pereyra 1973 (separable
// least squares). One-sided columns (a friction cannot be negative) are kept at or above zero by trying every
// subset. Validity: small changes; what is found here is refitted in full.
// Shapes: n weighted samples (whitened residual over its channel's scale, of no unit), p base unknowns off
// their bounds, c columns: J n x p, D n x c, r n, L p (diagonal), d p, a c.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "identify/estimate/whitened_residuals.h"
#include "sim/law/symmetric.h"

namespace omnihil {

struct LinearGain {
  double gain = 0.0;
  double data_gain = 0.0;            // without the priors' part: fall of |r - J d - D a|^2 alone
  std::vector<double> coefficients;  // a: size c
  Eigen::VectorXd base_shift;        // d: size p, in the unknowns' own units
};

// Columns orthogonalised against the base parameters.
struct ProjectedColumns {
  Eigen::MatrixXd columns;   // D - J A^-1 J'D: n x c
  Eigen::MatrixXd gram;      // Schur complement D'D - D'J A^-1 J'D: c x c
  Eigen::MatrixXd coupling;  // A^-1 J'D: p x c, in steps of the unknowns' scales
  double kept = 0.0;         // residual fraction of their energy: 1 - R^2 on the base derivatives
};

class LinearBase {
 public:
  LinearBase(const WhitenedResiduals& residuals, const Candidate& model, const std::vector<Unknown>& unknowns,
             const Eigen::VectorXd& scale_of_channel, int jobs);

  bool usable() const { return usable_; }
  const Eigen::VectorXd& residual() const { return residual_; }      // n, weighted
  const Eigen::VectorXd& weights() const { return weights_; }        // n
  const Eigen::VectorXd& prediction() const { return prediction_; }  // n, whitened, not weighted
  double energy() const { return residual_.squaredNorm(); }
  double autocorrelation_samples() const { return autocorrelation_; }
  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  const Eigen::MatrixXd& derivatives() const { return jacobian_; }  // n x p, per Unknown::scale

  ProjectedColumns project(Eigen::MatrixXd weighted_columns) const;
  LinearGain gain(const ProjectedColumns& columns, const std::vector<bool>& two_sided) const;
  // The gain with every coefficient fixed at 1: for a law whose signal does not grow in proportion to its
  // strength.
  LinearGain gain_as_tried(const ProjectedColumns& columns) const;
  // The gain by chance: of `noise` (n, weighted) in place of the residual.
  double gain_in_noise(const ProjectedColumns& columns, const std::vector<bool>& two_sided,
                       const Eigen::VectorXd& noise) const;

 private:
  Eigen::VectorXd correlation(const ProjectedColumns& columns) const;
  Eigen::VectorXd base_shift(const ProjectedColumns& columns, const Eigen::VectorXd& coefficients) const;
  LinearGain gain_at(double gain, const ProjectedColumns& columns, const Eigen::VectorXd& coefficients) const;

  bool usable_ = false;
  std::vector<Unknown> unknowns_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd prediction_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd jacobian_;
  Eigen::VectorXd prior_;     // L
  Eigen::VectorXd gradient_;  // g
  Eigen::VectorXd moved_;     // r - J A^-1 g
  Cholesky normal_;
  double autocorrelation_ = 1.0;
};

// Largest b'a of G a = b with a >= 0 where a column is one-sided; G c x c, b c. Returns {gain, a}.
std::pair<double, Eigen::VectorXd> bounded_gain(const Eigen::MatrixXd& gram,
                                                const Eigen::VectorXd& correlation,
                                                const std::vector<bool>& two_sided);

// Autocorrelation time in samples, 1 + 2 sum of autocorrelations up to the first below kFaded; mean over the
// parts.
double autocorrelation_samples(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual);

}  // namespace omnihil
