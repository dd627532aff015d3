#include "sim/rolling/rolling_params.h"

namespace omnihil {
namespace {

constexpr std::string_view kOwnPaths[] = {
    "robot.mass_kg",
    "robot.yaw_inertia_kg_m2",
    "robot.center_of_mass_x_m",
    "robot.center_of_mass_y_m",
    "robot.center_of_mass_height_m",
    "robot.wheel_center_radius_m",
    "robot.wheel_radius_m",
    "robot.wheel_inertia_kg_m2",
    "robot.slip_speed_floor_m_s",
    "tyre.longitudinal.extremum_slip",
    "tyre.longitudinal.extremum_value",
    "tyre.longitudinal.asymptote_slip",
    "tyre.longitudinal.asymptote_value",
    "tyre.lateral.extremum_slip",
    "tyre.lateral.extremum_value",
    "tyre.lateral.asymptote_slip",
    "tyre.lateral.asymptote_value",
    "controller.kp_V_s_per_rad",
    "controller.ki_V_per_rad",
    "controller.feedforward_V_s_per_rad",
    "controller.acceleration_feedforward_V_s2_per_rad",
    "controller.integral_limit_ratio",
    "controller.speed_filter_s",
    "controller.latency_s",
};

// In the order of kOwnPaths.
template <typename T>
std::array<T*, std::size(kOwnPaths)> own_numbers(RollingParams<T>& p) {
  return {&p.mass_kg,
          &p.yaw_inertia_kg_m2,
          &p.center_of_mass_x_m,
          &p.center_of_mass_y_m,
          &p.center_of_mass_height_m,
          &p.wheel_center_radius_m,
          &p.wheel_radius_m,
          &p.drive.load_inertia_kg_m2,
          &p.slip_speed_floor_m_s,
          &p.longitudinal.extremum_slip,
          &p.longitudinal.extremum_value,
          &p.longitudinal.asymptote_slip,
          &p.longitudinal.asymptote_value,
          &p.lateral.extremum_slip,
          &p.lateral.extremum_value,
          &p.lateral.asymptote_slip,
          &p.lateral.asymptote_value,
          &p.controller.loop.kp_V_s_per_rad,
          &p.controller.loop.ki_V_per_rad,
          &p.controller.loop.feedforward_V_s_per_rad,
          &p.controller.loop.acceleration_feedforward_V_s2_per_rad,
          &p.controller.loop.integral_limit_ratio,
          &p.controller.loop.speed_filter_s,
          &p.controller.latency_s};
}

}  // namespace

std::span<const std::string_view> rolling_paths() { return kOwnPaths; }

template <typename T>
T* rolling_number(RollingParams<T>& p, std::string_view path) {
  const auto own = own_numbers(p);
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (kOwnPaths[i] == path) return own[i];
  }
  for (const DriveParamPath& at : drive_param_paths()) {
    if (at.path != path) continue;
    if constexpr (std::is_same_v<T, double>) {
      return &(p.drive.*at.value);
    } else {
      return &(p.drive.*at.jet);
    }
  }
  return nullptr;
}

template <typename T>
RollingParams<T> rolling_params_as(const RollingParams<double>& p) {
  RollingParams<T> q;
  q.drive = drive_params_as<T>(p.drive);
  q.wheels = p.wheels;
  q.wheel_angle_rad = p.wheel_angle_rad;
  q.has_tyre = p.has_tyre;
  q.has_lateral_tyre = p.has_lateral_tyre;
  q.has_controller = p.has_controller;
  q.controller.acceleration_limit_m_s2 = p.controller.acceleration_limit_m_s2;
  q.controller.yaw_acceleration_limit_rad_s2 = p.controller.yaw_acceleration_limit_rad_s2;
  q.controller.rate_limit_rad_s2 = p.controller.rate_limit_rad_s2;
  q.controller.period_s = p.controller.period_s;
  q.controller.planned_grip = p.controller.planned_grip;
  q.controller.report_filter_s = p.controller.report_filter_s;
  q.controller.timeout_s = p.controller.timeout_s;
  q.controller.wheel_radius_m = p.controller.wheel_radius_m;
  q.controller.wheel_center_radius_m = p.controller.wheel_center_radius_m;
  RollingParams<double> from = p;
  const auto source = own_numbers(from);
  const auto target = own_numbers(q);
  for (std::size_t i = 0; i < source.size(); ++i) *target[i] = T(*source[i]);
  return q;
}

template double* rolling_number(RollingParams<double>&, std::string_view);
template Jet* rolling_number(RollingParams<Jet>&, std::string_view);
template RollingParams<double> rolling_params_as(const RollingParams<double>&);
template RollingParams<Jet> rolling_params_as(const RollingParams<double>&);

}  // namespace omnihil
