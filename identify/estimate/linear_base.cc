#include "identify/estimate/linear_base.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

// Where the sum of autocorrelations is cut: beyond, their estimate is noise (Sokal 1997 cuts by a window
// instead).
constexpr double kFaded = 0.1;  // a choice; sensitivity not measured
constexpr int kMostLags = 400;  // 0.4 s at 1 kHz, beyond a drive's time constants; bounds the cost; a choice

// Autocorrelation time of one part's residual, in samples.
double correlated_samples(const Eigen::Ref<const Eigen::VectorXd>& r) {
  const Eigen::Index n = r.size();
  const double energy = r.squaredNorm();
  if (energy <= 0.0) return 1.0;
  double sum = 1.0;
  const int most = static_cast<int>(std::min<Eigen::Index>(kMostLags, n / 4));
  for (int lag = 1; lag < most; ++lag) {
    const double rho = r.head(n - lag).dot(r.tail(n - lag)) / energy;
    if (rho < kFaded) break;
    sum += 2.0 * rho;
  }
  return sum;
}

Eigen::MatrixXd selected(const Eigen::MatrixXd& m, const std::vector<Eigen::Index>& rows) {
  Eigen::MatrixXd out(rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = m(rows[i], rows[j]);
    }
  }
  return out;
}

}  // namespace

double autocorrelation_samples(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual) {
  double sum = 0.0, weight = 0.0;
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    const Eigen::Index n = static_cast<Eigen::Index>(part.rows.size());
    sum += static_cast<double>(n) * correlated_samples(residual.segment(part.first, n));
    weight += static_cast<double>(n);
  }
  return weight > 0.0 ? sum / weight : 1.0;
}

std::pair<double, Eigen::VectorXd> bounded_gain(const Eigen::MatrixXd& gram,
                                                const Eigen::VectorXd& correlation,
                                                const std::vector<bool>& two_sided) {
  constexpr std::size_t kMostOneSided = 4;  // 2^4 subsets are solved; further columns are two-sided; a choice
  std::vector<Eigen::Index> one_sided;
  for (std::size_t c = 0; c < two_sided.size(); ++c) {
    if (!two_sided[c] && one_sided.size() < kMostOneSided) one_sided.push_back(static_cast<Eigen::Index>(c));
  }
  std::pair<double, Eigen::VectorXd> best{0.0, Eigen::VectorXd::Zero(correlation.size())};
  for (unsigned off = 0; off < (1u << one_sided.size()); ++off) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index c = 0; c < correlation.size(); ++c) {
      const auto at = std::find(one_sided.begin(), one_sided.end(), c);
      const bool dropped = at != one_sided.end() && ((off >> (at - one_sided.begin())) & 1u) != 0;
      if (!dropped && gram(c, c) > 0.0) rows.push_back(c);
    }
    if (rows.empty()) continue;
    Eigen::MatrixXd g = selected(gram, rows);
    g.diagonal() *= 1.0 + 1e-9;  // ridge, far above rounding: columns may be copies of each other
    Eigen::VectorXd b(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) b[static_cast<Eigen::Index>(i)] = correlation[rows[i]];
    const Eigen::VectorXd a = ldlt_solve(g, b);
    bool allowed = a.allFinite();
    for (std::size_t i = 0; i < rows.size() && allowed; ++i) {
      allowed = two_sided[static_cast<std::size_t>(rows[i])] || a[static_cast<Eigen::Index>(i)] >= 0.0;
    }
    const double gain = allowed ? b.dot(a) : 0.0;
    if (gain <= best.first) continue;
    best.first = gain;
    best.second.setZero();
    for (std::size_t i = 0; i < rows.size(); ++i) best.second[rows[i]] = a[static_cast<Eigen::Index>(i)];
  }
  return best;
}

LinearBase::LinearBase(const WhitenedResiduals& residuals, const Candidate& model,
                       const std::vector<Unknown>& unknowns, const Eigen::VectorXd& scale_of_channel,
                       int jobs) {
  weights_ = residuals.weights(scale_of_channel);
  prediction_ = residuals.predicted(model, jobs);
  if (prediction_.size() != residuals.size() || residuals.empty()) return;
  const Eigen::VectorXd raw = residuals.residual_of(prediction_);
  residual_ = raw.cwiseProduct(weights_);
  autocorrelation_ = omnihil::autocorrelation_samples(residuals, residual_);
  for (const Unknown& u : unknowns) {
    const double margin = 1e-6 * std::max(u.scale, 1e-12);
    // A base parameter at its bound stays fixed.
    if (u.start > u.lower + margin && u.start < u.upper - margin) unknowns_.push_back(u);
  }
  jacobian_ = residuals.derivatives(model, unknowns_, jobs);
  for (Eigen::Index c = 0; c < jacobian_.cols(); ++c) {
    // in steps that matter, so that the normal matrix is well scaled
    jacobian_.col(c) = jacobian_.col(c).cwiseProduct(weights_) * unknowns_[static_cast<std::size_t>(c)].scale;
  }
  prior_ = Eigen::VectorXd::Zero(jacobian_.cols());
  Eigen::VectorXd off = prior_;
  for (Eigen::Index c = 0; c < prior_.size(); ++c) {
    const Unknown& u = unknowns_[static_cast<std::size_t>(c)];
    if (u.prior_sigma > 0.0) {
      const double sigmas = u.scale * prior_dz(u, u.start);
      prior_[c] = autocorrelation_ * sigmas * sigmas;
      off[c] = prior_z(u, u.start) / sigmas;
    }
  }
  Eigen::MatrixXd normal = jacobian_.transpose() * jacobian_;
  normal.diagonal() += prior_;
  normal.diagonal().array() += 1e-12 * std::max(1.0, normal.diagonal().maxCoeff());
  normal_ = Cholesky(normal);
  gradient_ = jacobian_.transpose() * residual_ - prior_.cwiseProduct(off);
  usable_ = normal_.positive_definite();
  moved_ = residual_;
  if (usable_ && gradient_.size() > 0) moved_ -= jacobian_ * normal_.solve(gradient_);
}

ProjectedColumns LinearBase::project(Eigen::MatrixXd weighted_columns) const {
  ProjectedColumns out;
  const double energy = weighted_columns.squaredNorm();
  const Eigen::MatrixXd cross = jacobian_.transpose() * weighted_columns;
  out.coupling = cross.rows() > 0 ? normal_.solve(cross) : cross;
  out.gram = weighted_columns.transpose() * weighted_columns - cross.transpose() * out.coupling;
  out.columns = std::move(weighted_columns);
  if (out.coupling.rows() > 0) out.columns.noalias() -= jacobian_ * out.coupling;
  out.kept = energy > 0.0 ? out.columns.squaredNorm() / energy : 0.0;
  return out;
}

// D'r - D'J A^-1 g: the columns are D - J A^-1 J'D, so D'r = columns'r + coupling'J'r
Eigen::VectorXd LinearBase::correlation(const ProjectedColumns& p) const {
  Eigen::VectorXd b = p.columns.transpose() * residual_;
  if (p.coupling.rows() > 0) b += p.coupling.transpose() * (jacobian_.transpose() * residual_ - gradient_);
  return b;
}

Eigen::VectorXd LinearBase::base_shift(const ProjectedColumns& p, const Eigen::VectorXd& a) const {
  if (p.coupling.rows() == 0) return Eigen::VectorXd::Zero(0);
  Eigen::VectorXd shift = normal_.solve(gradient_) - p.coupling * a;
  for (Eigen::Index c = 0; c < shift.size(); ++c) shift[c] *= unknowns_[static_cast<std::size_t>(c)].scale;
  return shift;
}

// d = A^-1 g - coupling a, so r - J d - D a = (r - J A^-1 g) - columns a
LinearGain LinearBase::gain_at(double gain, const ProjectedColumns& p, const Eigen::VectorXd& a) const {
  return {.gain = gain,
          .data_gain = energy() - (moved_ - p.columns * a).squaredNorm(),
          .coefficients = {a.data(), a.data() + a.size()},
          .base_shift = base_shift(p, a)};
}

LinearGain LinearBase::gain(const ProjectedColumns& p, const std::vector<bool>& two_sided) const {
  const auto [gain, a] = bounded_gain(p.gram, correlation(p), two_sided);
  return gain_at(gain, p, a);
}

LinearGain LinearBase::gain_as_tried(const ProjectedColumns& p) const {
  const Eigen::VectorXd a = Eigen::VectorXd::Ones(p.gram.cols());
  // |r|^2 - |r - D a|^2 = 2 a'b - a'G a
  return gain_at(2.0 * a.dot(correlation(p)) - a.dot(p.gram * a), p, a);
}

double LinearBase::gain_in_noise(const ProjectedColumns& p, const std::vector<bool>& two_sided,
                                 const Eigen::VectorXd& noise) const {
  return bounded_gain(p.gram, p.columns.transpose() * noise, two_sided).first;
}

}  // namespace omnihil
