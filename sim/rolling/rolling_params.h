// What is fixed about one robot, on any scalar, for the robot that rolls (rolling_robot.h).
//
//   RollingParams<double> p = rolling_params(table);        // sim/model/rolling_model.h: from a model file's rows
//   RollingParams<Jet> q = rolling_params_as<Jet>(p);
//   *rolling_number(q, "robot.mass_kg") = Jet(2.4, 0);      // and it is unknown number 0
//
// A model that gives no tyre rolls without slip: what a tyre does then comes from the effects wheel_slip and
// lateral_roller_friction, whose neutral is rolling. A model that gives one has that tyre (tyre.h, slip.h).
#pragma once
#include <array>
#include <span>
#include <string_view>

#include "sim/law/drive_params.h"
#include "sim/robot/radio_controller.h"
#include "sim/robot/robot_model.h"
#include "sim/robot/tyre.h"

namespace omnihil {

template <typename T>
struct RollingTyre {
  T extremum_slip = T(0), extremum_value = T(0), asymptote_slip = T(0), asymptote_value = T(0);
};

template <typename T>
struct RollingParams {
  DriveParams<T> drive;  // of one wheel; its load is the wheel
  T mass_kg = T(0);
  T yaw_inertia_kg_m2 = T(0);  // about the geometric centre
  T center_of_mass_x_m = T(0), center_of_mass_y_m = T(0), center_of_mass_height_m = T(0);
  T wheel_center_radius_m = T(0);
  T wheel_radius_m = T(0);
  std::size_t wheels = kWheels;
  PerWheel<double> wheel_angle_rad{};
  bool has_tyre = false;          // false: rolls
  bool has_lateral_tyre = false;  // false: rollers turn freely
  RollingTyre<T> longitudinal, lateral;
  T slip_speed_floor_m_s = T(0);
  bool has_controller = false;  // false: it is driven by duties
  RadioControllerParams<T> controller;
};

// The number of the model file's row `path`; null: it has no place here. For double and Jet.
template <typename T>
T* rolling_number(RollingParams<T>& p, std::string_view path);

// The paths of a robot's own numbers; those of its drives are drive_param_paths().
std::span<const std::string_view> rolling_paths();

template <typename T>
RollingParams<T> rolling_params_as(const RollingParams<double>& p);

}  // namespace omnihil
