// The values of an `s` line. This table is the only place where they are named.
#include <array>

#include "hil/recording/recording.h"

namespace omnihil {
namespace {

using Columns = std::vector<SampleColumn>;
constexpr std::size_t kWheelCount = kWheels;

// `values` is a function of the sample that gives an array of one value per wheel.
template <auto values, std::size_t i>
double wheel_value(const RobotSample& sample) {
  return static_cast<double>(values(sample)[i]);
}

template <auto values>
void four(Columns& columns, const std::string& stem, const char* unit) {
  static_assert(kWheelCount == 4);
  columns.push_back({stem + "_1", unit, &wheel_value<values, 0>});
  columns.push_back({stem + "_2", unit, &wheel_value<values, 1>});
  columns.push_back({stem + "_3", unit, &wheel_value<values, 2>});
  columns.push_back({stem + "_4", unit, &wheel_value<values, 3>});
}

void add_drive(Columns& c) {
  four < [](const RobotSample& s) -> const auto& { return s.drive.duty_ratio; }
  > (c, "duty_ratio", "1");
  four < [](const RobotSample& s) -> const auto& { return s.drive.mode; }
  > (c, "drive_mode", "1");
  c.push_back({"drive_dribbler_ratio", "1", [](const RobotSample& s) { return s.drive.dribbler_ratio; }});
  c.push_back({"drive_kick", "1", [](const RobotSample& s) { return double(s.drive.kick); }});
}

void add_sensors(Columns& c) {
  four < [](const RobotSample& s) -> const auto& { return s.sensors.encoder_counts; }
  > (c, "encoder_counts", "counts");
  four < [](const RobotSample& s) -> const auto& { return s.sensors.motor_current_A; }
  > (c, "motor_current_A", "A");
  c.push_back({"bus_voltage_V", "V", [](const RobotSample& s) { return s.sensors.bus_voltage_V; }});
  c.push_back({"gyro_z_rad_s", "rad/s", [](const RobotSample& s) { return s.sensors.gyro_z_rad_s; }});
  c.push_back({"accel_x_m_s2", "m/s^2", [](const RobotSample& s) { return s.sensors.accel_x_m_s2; }});
  c.push_back({"accel_y_m_s2", "m/s^2", [](const RobotSample& s) { return s.sensors.accel_y_m_s2; }});
}

void add_feedback(Columns& c) {
  c.push_back({"feedback_flags", "1", [](const RobotSample& s) { return double(s.feedback.flags); }});
  c.push_back(
      {"feedback_v_forward_m_s", "m/s", [](const RobotSample& s) { return s.feedback.v_forward_m_s; }});
  c.push_back({"feedback_v_left_m_s", "m/s", [](const RobotSample& s) { return s.feedback.v_left_m_s; }});
  c.push_back({"feedback_omega_body_rad_s", "rad/s",
               [](const RobotSample& s) { return s.feedback.omega_body_rad_s; }});
  c.push_back({"feedback_yaw_rad", "rad", [](const RobotSample& s) { return s.feedback.yaw_rad; }, true});
  four < [](const RobotSample& s) -> const auto& { return s.feedback.omega_wheel_rad_s; }
  > (c, "feedback_omega_wheel_rad_s", "rad/s");
  four < [](const RobotSample& s) -> const auto& { return s.feedback.omega_wheel_target_rad_s; }
  > (c, "feedback_omega_wheel_target_rad_s", "rad/s");
}

void add_truth(Columns& c) {
  c.push_back({"true_x_m", "m", [](const RobotSample& s) { return s.truth.x_m; }});
  c.push_back({"true_y_m", "m", [](const RobotSample& s) { return s.truth.y_m; }});
  c.push_back({"true_yaw_rad", "rad", [](const RobotSample& s) { return s.truth.yaw_rad; }, true});
  c.push_back({"true_v_forward_m_s", "m/s", [](const RobotSample& s) { return s.truth.v_forward_m_s; }});
  c.push_back({"true_v_left_m_s", "m/s", [](const RobotSample& s) { return s.truth.v_left_m_s; }});
  c.push_back(
      {"true_omega_body_rad_s", "rad/s", [](const RobotSample& s) { return s.truth.omega_body_rad_s; }});
  four < [](const RobotSample& s) -> const auto& { return s.truth.theta_rotor_rad; }
  > (c, "true_theta_rotor_rad", "rad");
  four < [](const RobotSample& s) -> const auto& { return s.truth.omega_rotor_rad_s; }
  > (c, "true_omega_rotor_rad_s", "rad/s");
  four < [](const RobotSample& s) -> const auto& { return s.truth.omega_wheel_rad_s; }
  > (c, "true_omega_wheel_rad_s", "rad/s");
  four < [](const RobotSample& s) -> const auto& { return s.truth.motor_current_A; }
  > (c, "true_motor_current_A", "A");
  four < [](const RobotSample& s) -> const auto& { return s.truth.motor_torque_Nm; }
  > (c, "true_motor_torque_Nm", "Nm");
  four < [](const RobotSample& s) -> const auto& { return s.truth.slip_longitudinal_ratio; }
  > (c, "true_slip_longitudinal_ratio", "1");
  four < [](const RobotSample& s) -> const auto& { return s.truth.force_longitudinal_N; }
  > (c, "true_force_longitudinal_N", "N");
  four < [](const RobotSample& s) -> const auto& { return s.truth.force_lateral_N; }
  > (c, "true_force_lateral_N", "N");
  four < [](const RobotSample& s) -> const auto& { return s.truth.load_N; }
  > (c, "true_load_N", "N");
}

void add_vision(Columns& c) {
  c.push_back({"vision_x_m", "m", [](const RobotSample& s) { return s.vision.x_m; }});
  c.push_back({"vision_y_m", "m", [](const RobotSample& s) { return s.vision.y_m; }});
  c.push_back({"vision_yaw_rad", "rad", [](const RobotSample& s) { return s.vision.yaw_rad; }, true});
}

Columns make_columns() {
  Columns columns;
  add_drive(columns);
  add_sensors(columns);
  add_feedback(columns);
  add_vision(columns);
  add_truth(columns);
  return columns;
}

}  // namespace

const std::vector<SampleColumn>& sample_columns() {
  static const Columns columns = make_columns();
  return columns;
}

}  // namespace omnihil
