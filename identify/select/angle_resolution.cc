#include "identify/select/angle_resolution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace omnihil {
namespace {

// Time since the sample before, of the same signal and run; 0 at the first.
Eigen::VectorXd time_between(const WhitenedResiduals& residuals, const Eigen::VectorXd& time_s) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(residuals.size());
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    for (std::size_t i = 1; i < part.rows.size(); ++i) {
      const Eigen::Index at = part.first + static_cast<Eigen::Index>(i);
      const double since_s = time_s[at] - time_s[at - 1];
      if (std::isfinite(since_s)) out[at] = since_s;  // else points of a steady map: they have no time
    }
  }
  return out;
}

// Of what a law of the angle depends on, and how many periods are in a turn of it; null: on none.
const Eigen::VectorXd* drift_of(const EffectUse& use, const AngleDrift& drift, double& order) {
  const auto& rows = use.entry->info->params;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].trait != ParamTrait::kOrder) continue;
    order = use.values[i];
    return &drift.rotor_rad;
  }
  order = 1.0;
  const bool periodic = std::any_of(
      rows.begin(), rows.end(), [](const EffectParam& row) { return row.trait == ParamTrait::kPeriodic; });
  return periodic ? &drift.output_rad : nullptr;
}

}  // namespace

AngleDrift angle_drift(const WhitenedResiduals& residuals, const Candidate& model, double speed_error_rad_s) {
  // theta_k - theta_(k-1) is off by d_omega dt
  const Eigen::VectorXd output = speed_error_rad_s * time_between(residuals, residuals.track(model, "time"));
  return {.rotor_rad = drive_of(model).gear_ratio * output, .output_rad = output};
}

double unresolved_share(const EffectUse& use, const AngleDrift& drift, const Eigen::VectorXd& signal) {
  double order = 1.0;
  const Eigen::VectorXd* drifted = drift_of(use, drift, order);
  const double energy = signal.squaredNorm();
  if (drifted == nullptr || drifted->size() != signal.size() || energy <= 0.0) return 0.0;
  const auto lost = (order * drifted->array() >= std::numbers::pi).cast<double>();
  return (signal.array().square() * lost).sum() / energy;
}

}  // namespace omnihil
