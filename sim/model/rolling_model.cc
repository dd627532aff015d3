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

RollingParams<double> rolling_params(const ParameterTable& table) {
  RollingParams<double> p;
  p.drive = drive_params_of(table);
  p.drive.coulomb_friction_Nm = 0.0;  // the effect of that name
  for (const std::string_view path : rolling_paths()) {
    double* number = rolling_number(p, path);
    *number = table.value_or(path, *number);
  }
  if (const Parameter* angles = table.find("robot.wheel_angle_deg"); angles != nullptr) {
    for (std::size_t i = 0; i < kWheels && i < angles->values.size(); ++i) {
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
