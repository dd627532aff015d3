#include "identify/select/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr double kStructure = 0.10;  // of the null's energy
// ... of what the baseline left above the null. The right law in another form leaves a few per cent.
constexpr double kUnexplained = 0.10;
constexpr double kSpreads = 5.0;  // of the null's replicates

// Excess of each signal's energy over the null's.
Eigen::VectorXd excess_of(const WhitenedResiduals& residuals, const NullModel& null,
                          const ComparedChannels& channels, const Eigen::VectorXd& residual) {
  const Eigen::VectorXd floor = null.floor(residuals.split()), square = residuals.mean_square(residual);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(square.size());
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    // A measured bus voltage is given to the model: what it leaves there is no structure of the drive.
    if (channels.name[static_cast<std::size_t>(k)] == "bus_voltage") continue;
    if (floor[k] > 0.0) out[k] = square[k] / floor[k] - 1.0;
  }
  return out;
}

}  // namespace

ResidualExcess residual_excess_of(const Predictor& predictor, const ComparedChannels& channels,
                                  const Candidate& baseline, const Candidate& last, std::uint64_t seed,
                                  int jobs) {
  constexpr int kReplicates = 8;
  ResidualExcess out;
  const Splits splits{WhitenedResiduals(predictor, channels, Split::kTraining, Weighing::kUnweighted),
                      WhitenedResiduals(predictor, channels, Split::kValidation, Weighing::kUnweighted),
                      WhitenedResiduals(predictor, channels, Split::kExtrapolation, Weighing::kUnweighted)};
  const std::size_t u = splits[kValidation].empty() ? kTraining : kValidation;
  const Eigen::VectorXd first = splits[u].residual(baseline, jobs), now = splits[u].residual(last, jobs);
  if (splits[u].empty() || first.size() == 0 || now.size() == 0) return out;
  const NullModel null = simulate_null(predictor, last, splits, seed, kReplicates, jobs);
  const Eigen::VectorXd before = excess_of(splits[u], null, channels, first);
  const Eigen::VectorXd after = excess_of(splits[u], null, channels, now);
  Eigen::Index worst = 0;
  out.excess = after.maxCoeff(&worst);
  out.excess_before = before[worst];
  out.signal = channels.name[static_cast<std::size_t>(worst)];
  const double floor = null.floor(splits[u].split())[worst];
  out.spread = floor > 0.0 ? null.spread(splits[u].split())[worst] / floor : 0.0;
  double left = 0.0, all = 0.0;
  for (Eigen::Index k = 0; k < after.size(); ++k) {
    if (before[k] <= 0.0) continue;
    const double weight = before[k] / (1.0 + before[k]);  // a signal at its floor has nothing to explain
    left += weight * std::clamp(after[k] / before[k], 0.0, 1.0);
    all += weight;
  }
  out.unexplained = all > 0.0 ? left / all : 0.0;
  return out;
}

bool structure_remains(const ResidualExcess& rest, bool effects_added) {
  const bool above_chance = rest.excess > kSpreads * rest.spread;
  if (!above_chance || rest.excess < kStructure) return false;
  return !effects_added || rest.unexplained > kUnexplained;
}

bool structure_in(const WhitenedResiduals& residuals, const NullModel& null, const ComparedChannels& channels,
                  const Eigen::VectorXd& residual) {
  if (residuals.empty() || residual.size() != residuals.size()) return false;
  const Eigen::VectorXd excess = excess_of(residuals, null, channels, residual);
  const Eigen::VectorXd floor = null.floor(residuals.split()), spread = null.spread(residuals.split());
  for (Eigen::Index k = 0; k < excess.size(); ++k) {
    if (excess[k] >= kStructure && excess[k] * floor[k] > kSpreads * spread[k]) return true;
  }
  return false;
}

std::string residual_sentence(const ResidualExcess& rest, bool effects_added) {
  const std::string size = fmt::format(
      "the error energy of {} is {:.0f} % above what the sensors' noise alone would leave "
      "(simulated; its replicates scatter by {:.1f} %)",
      rest.signal, 100.0 * rest.excess, 100.0 * rest.spread);
  if (structure_remains(rest, effects_added)) {
    return "Structure remains that no known effect explains: " + size + ".";
  }
  if (effects_added && rest.excess_before < kStructure) {
    // named for what the model file says, not for what it takes
    return "Nothing more that matters can be learned from these data: " + size + ".";
  }
  if (effects_added) {
    return fmt::format(
        "Nothing more that matters can be learned from these data: {}; {:.0f} % of what the base "
        "model left is explained.",
        size, 100.0 * (1.0 - rest.unexplained));
  }
  return "Nothing that matters is missing as far as these data show: " + size + ".";
}

}  // namespace omnihil
