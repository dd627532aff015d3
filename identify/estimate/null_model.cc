#include "identify/estimate/null_model.h"

#include <cmath>

#include "identify/record/parallel.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

// A robot's model takes measured heading and position as inputs (identify/rigs/robot.cc). In a null replicate they
// must come from the simulated truth; with the recording's, the fitted model's error of path would be counted
// as noise (DECISIONS 41).
bool has_pose_inputs(const Predictor& predictor) {
  for (int run = 0; run < predictor.run_count(); ++run) {
    for (const ComparedSignal& s : predictor.compared(run)) {
      if (s.name.starts_with("gyro") || s.name.starts_with("vision")) return true;
    }
  }
  return false;
}

}  // namespace

Eigen::VectorXd NullModel::floor(Split split) const {
  const Eigen::MatrixXd& m = mean_square[static_cast<std::size_t>(split)];
  return m.rows() > 0 ? Eigen::VectorXd(m.colwise().mean())
                      : Eigen::VectorXd(Eigen::VectorXd::Zero(m.cols()));
}

Eigen::VectorXd NullModel::spread(Split split) const {
  const Eigen::MatrixXd& m = mean_square[static_cast<std::size_t>(split)];
  if (m.rows() < 2) return Eigen::VectorXd::Zero(m.cols());
  const Eigen::RowVectorXd mean = m.colwise().mean();
  const Eigen::MatrixXd off = m.rowwise() - mean;
  return (off.array().square().colwise().sum() / static_cast<double>(m.rows() - 1)).sqrt().transpose();
}

Eigen::VectorXd simulated_residual(const Predictor& simulated, const WhitenedResiduals& residuals,
                                   const Candidate& model, const Eigen::VectorXd& predicted) {
  const Eigen::VectorXd own =
      has_pose_inputs(simulated) ? residuals.predicted_by(simulated, model) : predicted;
  return own.size() == residuals.size() ? Eigen::VectorXd(residuals.measured_by(simulated) - own)
                                        : Eigen::VectorXd();
}

NullModel simulate_null(const Predictor& predictor, const Candidate& truth,
                        const std::array<WhitenedResiduals, kSplits>& splits, std::uint64_t seed,
                        int replicates, int jobs) {
  NullModel null;
  null.fit_noise.resize(static_cast<std::size_t>(replicates));
  std::array<Eigen::VectorXd, kSplits> predicted;
  for (std::size_t u = 0; u < kSplits; ++u) {
    if (!splits[u].empty()) predicted[u] = splits[u].predicted(truth, jobs);
    null.mean_square[u] = Eigen::MatrixXd::Zero(replicates, splits[u].samples().size());
  }
  parallel_for(jobs, replicates, [&](int k) {
    const std::unique_ptr<Predictor> simulated =
        predictor.simulated(truth, random_bits(seed, stream_of("null"), static_cast<std::uint64_t>(k)));
    for (std::size_t u = 0; u < kSplits; ++u) {
      if (splits[u].empty()) continue;
      Eigen::VectorXd noise = simulated_residual(*simulated, splits[u], truth, predicted[u]);
      if (noise.size() == 0) continue;
      noise = noise.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
      null.mean_square[u].row(k) = splits[u].mean_square(noise).transpose();
      if (u == static_cast<std::size_t>(Split::kTraining))
        null.fit_noise[static_cast<std::size_t>(k)] = std::move(noise);
    }
  });
  return null;
}

}  // namespace omnihil
