#include "identify/predict/torque_scale.h"

#include <algorithm>
#include <cmath>

#include "identify/record/rig.h"
#include "identify/record/statistics.h"
#include "sim/law/param_range.h"

namespace omnihil {
namespace {

constexpr double kRobotTorque_Nm =
    0.1;  // source: data sheet of an EC 45 flat, 50 W: 84 mN m for ever, rounded up

// At standstill: 0.0335 N m/A x 22.2 V / 0.464 ohm of the example robot's wheel motor.
constexpr double kRobotStall_Nm = 1.6;  // derived

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

// Of a drive that is asked for a voltage: what it could do at standstill, k U / R, by the largest voltage of the record, else
// by the supply. 0: not known.
double stall_torque_Nm(const Dataset& dataset, const Candidate& nominal) {
  const auto number = [&](const char* path) { return value_at(nominal, path).value_or(0.0); };
  const double resistance = number("motor.resistance_ohm");
  if (dataset.rig->of_robot || dataset.linear || !(resistance > 0.0)) return 0.0;
  double voltage = dataset.channel("motor_voltage") == nullptr ? number("supply.voltage_V") : 0.0;
  for (const Run& run : dataset.runs) {
    for (const char* name : {"motor_voltage", "bus_voltage"}) {
      const std::vector<double>* values = run.signal(name);
      if (values != nullptr && run.split == Split::kTraining)
        voltage = std::max(voltage, largest_size(*values));
    }
  }
  return number("motor.torque_constant_Nm_per_A") * voltage / resistance;
}

}  // namespace

double torque_scale_of(const Dataset& dataset, const Candidate& nominal) {
  const TorqueColumn column = torque_column(dataset, nominal);
  if (column.signal == nullptr)
    return std::clamp(stall_torque_Nm(dataset, nominal) / kRobotStall_Nm, 1.0, kStrongestDrive);
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
