#include "sim/model/rolling_model.h"

#include <numbers>

#include "sim/model/axis_model.h"

namespace omnihil {
namespace {

bool given(const ParameterTable& table, std::string_view section) {
  for (const Parameter& p : table.parameters) {
    if (p.row->section == section && p.origin != Origin::kDefault && !p.values.empty()) return true;
  }
  return false;
}

}  // namespace

std::size_t wheel_count(const ParameterTable& table) {
  const Parameter* angles = table.find("robot.wheel_angle_deg");
  return angles != nullptr && !angles->values.empty() ? angles->values.size() : std::size_t{kWheels};
}

std::vector<std::string> per_wheel(std::string_view signal, std::size_t wheels) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= wheels; ++i) names.push_back(std::string(signal) + "_" + std::to_string(i));
  return names;
}

RollingParams<double> rolling_params(const ParameterTable& table) {
  RollingParams<double> p;
  p.drive = drive_params_of(table);
  p.drive.coulomb_friction_Nm = 0.0;  // the effect of that name
  for (const std::string_view path : rolling_paths()) {
    double* number = rolling_number(p, path);
    *number = table.value_or(path, *number);
  }
  if (const Parameter* angles = table.find("robot.wheel_angle_deg"); angles != nullptr) {
    p.wheels = angles->values.size();
    for (std::size_t i = 0; i < p.wheels; ++i) {
      p.wheel_angle_rad[i] = angles->values[i] * std::numbers::pi / 180.0;
    }
  }
  p.has_tyre = given(table, "tyre.longitudinal");
  p.has_lateral_tyre = given(table, "tyre.lateral");
  p.has_controller = given(table, "controller");
  p.controller.period_s = table.value_or("controller.period_s", p.controller.period_s);
  p.controller.acceleration_limit_m_s2 = table.value_or("controller.acceleration_limit_m_s2", 0.0);
  p.controller.yaw_acceleration_limit_rad_s2 =
      table.value_or("controller.yaw_acceleration_limit_rad_s2", 0.0);
  p.controller.rate_limit_rad_s2 = table.value_or("controller.rate_limit_rad_s2", 0.0);
  p.controller.report_filter_s = table.value_or("controller.report_filter_s", 0.0);
  p.controller.planned_grip = table.value_or("controller.planned_grip", 0.0);
  p.controller.timeout_s = table.value_or("controller.timeout_s", 0.0);
  p.controller.wheel_radius_m = table.value_or("controller.wheel_radius_m", 0.0);
  p.controller.wheel_center_radius_m = table.value_or("controller.wheel_center_radius_m", 0.0);
  return p;
}

}  // namespace omnihil
