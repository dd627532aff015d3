#include "identify/estimate/null_model.h"

#include <cmath>

#include "identify/record/parallel.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

// A robot's model follows the measured heading and place (predictor_robot.h): those of its own world, or the
// way that the fitted model strays from the measured one would count as noise.
bool follows_its_place(const Predictor& predictor) {
  for (int run = 0; run < predictor.run_count(); ++run) {
    for (const ComparedSignal& s : predictor.compared(run)) {
      if (s.name.starts_with("gyro") || s.name.starts_with("vision")) return true;
    }
  }
  return false;
}

}  // namespace

Eigen::VectorXd NullModel::floor(Use use) const {
  const Eigen::MatrixXd& m = mean_square[static_cast<std::size_t>(use)];
  return m.rows() > 0 ? Eigen::VectorXd(m.colwise().mean())
                      : Eigen::VectorXd(Eigen::VectorXd::Zero(m.cols()));
}

Eigen::VectorXd NullModel::spread(Use use) const {
  const Eigen::MatrixXd& m = mean_square[static_cast<std::size_t>(use)];
  if (m.rows() < 2) return Eigen::VectorXd::Zero(m.cols());
  const Eigen::RowVectorXd mean = m.colwise().mean();
  const Eigen::MatrixXd off = m.rowwise() - mean;
  return (off.array().square().colwise().sum() / static_cast<double>(m.rows() - 1)).sqrt().transpose();
}

Eigen::VectorXd left_in(const Predictor& world, const Evidence& evidence, const Candidate& model,
                        const Eigen::VectorXd& predicted) {
  const Eigen::VectorXd own = follows_its_place(world) ? evidence.predicted_by(world, model) : predicted;
  return own.size() == evidence.size() ? Eigen::VectorXd(evidence.measured_by(world) - own)
                                       : Eigen::VectorXd();
}

NullModel simulate_null(const Predictor& predictor, const Candidate& truth,
                        const std::array<Evidence, kUses>& uses, std::uint64_t seed, int replicates,
                        int jobs) {
  NullModel null;
  null.fit_noise.resize(static_cast<std::size_t>(replicates));
  std::array<Eigen::VectorXd, kUses> predicted;
  for (std::size_t u = 0; u < kUses; ++u) {
    if (!uses[u].empty()) predicted[u] = uses[u].predicted(truth, jobs);
    null.mean_square[u] = Eigen::MatrixXd::Zero(replicates, uses[u].samples().size());
  }
  parallel_for(jobs, replicates, [&](int k) {
    const std::unique_ptr<Predictor> world =
        predictor.simulated(truth, random_bits(seed, stream_of("null"), static_cast<std::uint64_t>(k)));
    for (std::size_t u = 0; u < kUses; ++u) {
      if (uses[u].empty()) continue;
      Eigen::VectorXd noise = left_in(*world, uses[u], truth, predicted[u]);
      if (noise.size() == 0) continue;
      noise = noise.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
      null.mean_square[u].row(k) = uses[u].mean_square(noise).transpose();
      if (u == static_cast<std::size_t>(Use::kFit))
        null.fit_noise[static_cast<std::size_t>(k)] = std::move(noise);
    }
  });
  return null;
}

}  // namespace omnihil
