#include "identify/predict/torque_scale.h"

#include <algorithm>
#include <cmath>

#include "identify/record/rig.h"
#include "sim/law/param_range.h"

namespace omnihil {
namespace {

constexpr double kRobotTorque_Nm =
    0.1;  // source: data sheet of an EC 45 flat, 50 W: 84 mN m for ever, rounded up

// The column that says the torque, and what makes N m of it; null: none does.
struct TorqueColumn {
  const char* signal = nullptr;
  double Nm_per_unit = 1.0;
};

TorqueColumn torque_column(const Dataset& dataset, const Candidate& nominal) {
  if (dataset.rig->of_robot || dataset.linear) return {};
  if (dataset.channel("motor_torque") != nullptr) return {"motor_torque", 1.0};
  const Channel* current = dataset.channel("motor_current");
  if (current == nullptr || !current->imposed) return {};
  return {"motor_current", value_at(nominal, "motor.torque_constant_Nm_per_A").value_or(0.0)};
}

}  // namespace

double torque_scale_of(const Dataset& dataset, const Candidate& nominal) {
  const TorqueColumn column = torque_column(dataset, nominal);
  if (column.signal == nullptr) return 1.0;
  double squares = 0.0, count = 0.0;
  for (const Run& run : dataset.runs) {
    const std::vector<double>* values = run.signal(column.signal);
    if (values == nullptr || run.split != Split::kTraining) continue;
    for (const double v : *values) {
      if (!std::isfinite(v)) continue;
      squares += v * v;
      count += 1.0;
    }
  }
  const double rms_Nm = count > 0.0 ? column.Nm_per_unit * std::sqrt(squares / count) : 0.0;
  return std::clamp(rms_Nm / kRobotTorque_Nm, 1.0, kStrongestDrive);
}

}  // namespace omnihil
