#include "identify/estimate/gain.h"

#include <algorithm>
#include <cmath>

#include "identify/record/statistics.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr int kDraws =
    200;  // a 5 % quantile has a standard error of sqrt(0.05 * 0.95 / 200) = 1.5 % in rank; by cost
constexpr double kFloorWeight = 0.05;  // no channel gets worse unseen; a choice, sensitivity not measured
constexpr double kUnmoved = 1e-9;  // of a channel's error energy: between rounding and any effect; a choice

double quantile_of(const Eigen::VectorXd& draws, double share) {
  return quantile({draws.begin(), draws.end()}, share, QuantileRank::kLower);
}

// Size m: each channel's share of error energy above the null's floor, at least kFloorWeight.
Eigen::VectorXd signal_weights(const WhitenedResiduals& residuals, const NullModel& null,
                               const Eigen::VectorXd& reference) {
  const Eigen::VectorXd floor = null.floor(residuals.split()), square = residuals.mean_square(reference);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(square.size());
  for (Eigen::Index k = 0; k < square.size(); ++k) {
    if (square[k] > 0.0) weights[k] = std::max(kFloorWeight, 1.0 - floor[k] / square[k]);
  }
  return weights;
}

}  // namespace

BlockBootstrap::BlockBootstrap(const WhitenedResiduals& residuals, std::uint64_t seed)
    : residuals_(&residuals) {
  const int blocks = residuals.blocks();
  if (blocks == 0) return;
  counts_ = Eigen::MatrixXd::Zero(kDraws, blocks);
  for (int d = 0; d < kDraws; ++d) {
    for (int b = 0; b < blocks; ++b) {
      const std::uint64_t counter = static_cast<std::uint64_t>(d) * 1000003u + static_cast<std::uint64_t>(b);
      const int drawn = static_cast<int>(uniform(seed, stream_of("bootstrap"), counter) * blocks);
      counts_(d, std::min(drawn, blocks - 1)) += 1.0;
    }
  }
}

Eigen::VectorXd BlockBootstrap::ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                                       const Eigen::VectorXd& weights) const {
  const Eigen::MatrixXd before = counts_ * residuals_->block_sums(reference);
  const Eigen::MatrixXd after = counts_ * residuals_->block_sums(residual);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(counts_.rows());
  double all = 0.0;
  for (Eigen::Index k = 0; k < before.cols(); ++k) {
    if (weights[k] <= 0.0 || before.col(k).sum() <= 0.0) continue;
    all += weights[k];
    for (Eigen::Index d = 0; d < out.size(); ++d) {
      out[d] += weights[k] * (before(d, k) > 0.0 ? after(d, k) / before(d, k) : 1.0);
    }
  }
  return all > 0.0 ? Eigen::VectorXd(out / all) : Eigen::VectorXd::Ones(counts_.rows());
}

SplitGain BlockBootstrap::gain(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                               const Eigen::VectorXd& weights) const {
  const Eigen::VectorXd draws = ratios(reference, residual, weights);
  return {.ratio = energy_ratio(*residuals_, reference, residual, weights),
          .best = quantile_of(draws, 0.05),
          .worst = quantile_of(draws, 0.95)};
}

Eigen::VectorXd weights_for(const WhitenedResiduals& residuals, const NullModel& null,
                            const Eigen::VectorXd& parent, const Eigen::VectorXd& child) {
  Eigen::VectorXd all = signal_weights(residuals, null, parent);
  if (child.size() != parent.size()) return all;
  const Eigen::VectorXd moved = residuals.mean_square(child - parent), size = residuals.mean_square(parent);
  Eigen::VectorXd weights = all;
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    if (moved[k] <= kUnmoved * size[k]) weights[k] = 0.0;
  }
  return weights.sum() > 0.0 ? weights : all;
}

double energy_ratio(const WhitenedResiduals& residuals, const Eigen::VectorXd& reference,
                    const Eigen::VectorXd& residual, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd before = residuals.mean_square(reference), after = residuals.mean_square(residual);
  double sum = 0.0, all = 0.0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    if (before[k] <= 0.0) continue;
    const double weight = weights.size() > 0 ? weights[k] : 1.0;
    sum += weight * after[k] / before[k];
    all += weight;
  }
  return all > 0.0 ? sum / all : 1.0;
}

double pooled_error(const WhitenedResiduals& residuals, const ComparedChannels& channels,
                    const Eigen::VectorXd& residual) {
  const Eigen::VectorXd square = residuals.mean_square(residual);
  double sum = 0.0, signals = 0.0;
  for (int k = 0; k < channels.count(); ++k) {
    const double sigma = channels.noise_sigma[static_cast<std::size_t>(k)];
    if (residuals.samples()[k] <= 0.0 || sigma <= 0.0) continue;
    sum += square[k] / (sigma * sigma);
    signals += 1.0;
  }
  return signals > 0.0 ? std::sqrt(sum / signals) : 0.0;
}

double floor_share(const WhitenedResiduals& residuals, const NullModel& null, const Eigen::VectorXd& residual,
                   const Eigen::VectorXd& weights) {
  if (residuals.empty()) return 1.0;
  const Eigen::VectorXd floor = null.floor(residuals.split()), square = residuals.mean_square(residual);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < square.size(); ++k) {
    if (square[k] > 0.0) sum += weights[k] * std::min(1.0, floor[k] / square[k]);
  }
  return weights.sum() > 0.0 ? sum / weights.sum() : 1.0;
}

}  // namespace omnihil
