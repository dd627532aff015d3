#include "identify/estimate/evidence.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr Eigen::Index kLongestLag = 2000;  // samples, by cost
constexpr Eigen::Index kEveryLag =
    50;  // up to here; beyond, lags grow by 4 %, which the integral does not see; by cost
constexpr double kWindow = 5.0;  // of the integral, in autocorrelation times: source, Sokal 1997

bool usable(const WhitenedResiduals& residuals, const ResidualPair& pair) {
  return !residuals.empty() && pair.parent.size() == residuals.size() &&
         pair.child.size() == residuals.size();
}

// Autocovariance of one channel at a lag, over all parts; each part about its own mean.
double autocovariance(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual, int channel,
                      Eigen::Index lag) {
  double sum = 0.0, count = 0.0;
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    const Eigen::Index n = static_cast<Eigen::Index>(part.rows.size());
    if (part.channel != channel || n <= lag) continue;
    const auto x = residual.segment(part.first, n);
    const double mean = x.mean();
    sum += (x.head(n - lag).array() - mean).matrix().dot((x.tail(n - lag).array() - mean).matrix());
    count += static_cast<double>(n - lag);
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

double autocorrelation_time(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual,
                            int channel) {
  const double variance = autocovariance(residuals, residual, channel, 0);
  if (variance <= 0.0) return 1.0;
  // tau = 1 + 2 sum rho(k), by trapezia between the lags taken
  double tau = 1.0, rho_last = 1.0;
  Eigen::Index last = 0;
  for (Eigen::Index lag = 1; lag < kLongestLag;
       lag += std::max<Eigen::Index>(1, lag < kEveryLag ? 1 : lag / 25)) {
    const double rho = autocovariance(residuals, residual, channel, lag) / variance;
    tau += lag <= kEveryLag ? 2.0 * rho : (rho + rho_last) * static_cast<double>(lag - last);
    if (rho < 0.0 || static_cast<double>(lag) > kWindow * tau) break;
    rho_last = rho;
    last = lag;
  }
  return std::max(1.0, tau);
}

Evidence evidence_of(const WhitenedResiduals& training, const ResidualPair& fit,
                     const WhitenedResiduals& validation, const ResidualPair& held_out,
                     int extra_parameters) {
  Evidence out;
  if (!usable(training, fit)) return out;
  const Eigen::VectorXd before = training.mean_square(fit.parent), after = training.mean_square(fit.child);
  double samples = 0.0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    if (before[k] <= 0.0 || after[k] <= 0.0) continue;
    const double n = training.samples()[k] / autocorrelation_time(training, fit.child, static_cast<int>(k));
    // -2 log L of a Gaussian residual of unknown variance: n log(mean square)
    out.delta_bic += n * std::log(after[k] / before[k]);
    samples += n;
  }
  out.delta_bic += extra_parameters * std::log(std::max(samples, 1.0));
  if (!usable(validation, held_out)) return out;
  const Eigen::MatrixXd parent = validation.block_sums(held_out.parent),
                        child = validation.block_sums(held_out.child);
  Eigen::VectorXd blocks = Eigen::VectorXd::Zero(parent.rows());
  for (Eigen::Index k = 0; k < parent.cols(); ++k) {
    if (before[k] <= 0.0 || after[k] <= 0.0) continue;
    const double tau = autocorrelation_time(validation, held_out.child, static_cast<int>(k));
    // log p = -r^2 / (2 s^2) - log(s), s^2 of the fit runs, one in tau samples independent
    blocks += (0.5 * (parent.col(k) / before[k] - child.col(k) / after[k]) +
               0.5 * std::log(before[k] / after[k]) * validation.block_samples().col(k)) /
              tau;
  }
  const double count = static_cast<double>(blocks.size());
  out.delta_elpd = blocks.sum();
  if (count > 1.0)
    out.delta_elpd_se = std::sqrt(count / (count - 1.0) * (blocks.array() - blocks.mean()).square().sum());
  return out;
}

}  // namespace omnihil
