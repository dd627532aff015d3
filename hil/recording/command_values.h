// A command that reached a firmware past the radio, as the numbers of a recording's `c` line.
//
//   std::vector<double> values = command_values(RobotCommand{});       // kCommandValues of them
//   RobotCommand again = command_of(values);                    // the same command
//
// Order: mode, flags, kick, kick_when, v_forward_m_s, v_left_m_s, omega_body_rad_s, omega_wheel_rad_s of four wheels,
// duty_ratio of four wheels, yaw_target_rad, camera_yaw_rad, a_feedforward_m_s2, a_feedforward_angle_rad, v_kick_m_s,
// kick_pulse_s, dribbler_ratio.
#pragma once
#include <span>
#include <vector>

#include "firmware_iface/robot_io.h"

namespace omnihil {

inline constexpr std::size_t kCommandValues = 7 + 2 * kWheels + 7;

std::vector<double> command_values(const RobotCommand& command);
RobotCommand command_of(std::span<const double> values);  // kCommandValues of them

}  // namespace omnihil
