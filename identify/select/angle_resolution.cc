#include "identify/select/angle_resolution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/record/rig.h"

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

// Of the angle that a law depends on; null: on none.
const Eigen::VectorXd* drift_of(const EffectInfo& info, const AngleDrift& drift) {
  if (info.of_angle == LawOfAngle::kNone) return nullptr;
  return info.of_angle == LawOfAngle::kRotor ? &drift.rotor_rad : &drift.output_rad;
}

// Periods in a turn of it.
double order_of(const EffectUse& use) {
  const auto& rows = use.entry->info->params;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].trait == ParamTrait::kOrder) return use.values[i];
  }
  return 1.0;
}

}  // namespace

AngleSource angle_source(const Dataset& dataset) {
  const bool sensor = std::any_of(dataset.channels.begin(), dataset.channels.end(), [](const Channel& c) {
    return c.signal.starts_with("encoder") || c.signal == "position";
  });
  if (sensor) return AngleSource::kSensor;
  return dataset.rig->of_robot ? AngleSource::kNone : AngleSource::kSpeed;
}

AngleDrift angle_drift(const WhitenedResiduals& residuals, const Candidate& model, double speed_error_rad_s) {
  if (std::isinf(speed_error_rad_s)) {
    const Eigen::VectorXd lost = Eigen::VectorXd::Constant(residuals.size(), speed_error_rad_s);
    return {.rotor_rad = lost, .output_rad = lost};
  }
  // theta_k - theta_(k-1) is off by d_omega dt
  const Eigen::VectorXd output = speed_error_rad_s * time_between(residuals, residuals.track(model, "time"));
  return {.rotor_rad = drive_of(model).gear_ratio * output, .output_rad = output};
}

double unresolved_share(const EffectUse& use, const AngleDrift& drift, const Eigen::VectorXd& signal) {
  const Eigen::VectorXd* drifted = drift_of(*use.entry->info, drift);
  const double energy = signal.squaredNorm();
  if (drifted == nullptr || drifted->size() != signal.size() || energy <= 0.0) return 0.0;
  const auto lost = (order_of(use) * drifted->array() >= std::numbers::pi).cast<double>();
  return (signal.array().square() * lost).sum() / energy;
}

bool is_never_resolved(const EffectInfo& info, const AngleDrift& drift) {
  const Eigen::VectorXd* drifted = drift_of(info, drift);
  return drifted != nullptr && drifted->size() > 0 && drifted->minCoeff() >= std::numbers::pi;
}

bool lacks_phase(const EffectInfo& info, const Dataset& dataset) {
  return info.of_angle != LawOfAngle::kNone && angle_source(dataset) == AngleSource::kNone;
}

std::string why_not(const EffectEntry& entry, const Predictor& predictor, const Dataset& dataset) {
  std::string why = predictor.applies(entry);
  return why.empty() && lacks_phase(*entry.info, dataset) ? std::string(kNoPhase) : why;
}

}  // namespace omnihil
