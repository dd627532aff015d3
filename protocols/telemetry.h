// What a robot tells of itself, out of its team's own packets, in SI: the way back of a dongle's answers.
//
//   if (std::optional<TelemetryReading> told = telemetry_of(format, decoded.values)) told->battery_V;
//
// Rows of this table hold for the packet and field of that name in any format; formats from files say it by the meaning
// of their fields (meaning.h). What a packet does not carry is NaN. A field at the end of its range is told as it stands.
// Cannot: tell when it was measured, but for when the packet came.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "protocols/radio_format.h"

namespace omnihil {

struct TelemetryReading {
  static constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
  int robot_id = -1;  // -1: the packet names none; a wire is one robot
  std::array<double, kWheels> omega_wheel_rad_s{kNotTold, kNotTold, kNotTold, kNotTold};
  std::array<double, kWheels> motor_current_A{kNotTold, kNotTold, kNotTold, kNotTold};
  double battery_V = kNotTold;
  double yaw_rad = kNotTold;           // as the robot believes it
  double omega_body_rad_s = kNotTold;  // of its gyro
};

// None: no packet of a robot, or one that tells nothing of this.
std::optional<TelemetryReading> telemetry_of(const RadioFormat& format, const Values& values);

// Whether any packet of the format tells wheel speeds; the same of anything at all.
bool tells_wheel_speeds(const RadioFormat& format);
bool tells_anything(const RadioFormat& format);
// Step of a told wheel speed, rad/s; 0: it has none, or is not told.
double wheel_speed_step_rad_s(const RadioFormat& format);

}  // namespace omnihil
