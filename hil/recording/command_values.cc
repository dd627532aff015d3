#include "hil/recording/command_values.h"

namespace omnihil {
namespace {

// Calls `each` with every number of the command, in the order of the file.
template <class Command, class Each>
void for_each_value(Command& c, Each&& each) {
  each(c.mode);
  each(c.flags);
  each(c.kick);
  each(c.kick_when);
  each(c.v_forward_m_s);
  each(c.v_left_m_s);
  each(c.omega_body_rad_s);
  for (auto& omega : c.omega_wheel_rad_s) each(omega);
  for (auto& duty : c.duty_ratio) each(duty);
  each(c.yaw_target_rad);
  each(c.camera_yaw_rad);
  each(c.a_feedforward_m_s2);
  each(c.a_feedforward_angle_rad);
  each(c.v_kick_m_s);
  each(c.kick_pulse_s);
  each(c.dribbler_ratio);
}

}  // namespace

std::vector<double> command_values(const RobotCommand& command) {
  std::vector<double> values;
  values.reserve(kCommandValues);
  for_each_value(command, [&](const auto& value) { values.push_back(static_cast<double>(value)); });
  return values;
}

RobotCommand command_of(std::span<const double> values) {
  RobotCommand command{};
  std::size_t at = 0;
  for_each_value(command,
                 [&](auto& value) { value = static_cast<std::decay_t<decltype(value)>>(values[at++]); });
  return command;
}

}  // namespace omnihil
