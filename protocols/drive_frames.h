// Four duties as frames of a radio format, for formats with a packet that hands duties to the bridges.
//
//   std::vector<std::uint8_t> bytes;
//   if (can_drive_by_duty(format)) append_duty_frames(format, {.id = 3}, {0.1, 0, -0.1, 0}, true, bytes);
//
// ulaval-hermes: SET_REGISTER (control loop open) once, then OPEN_LOOP_COMMAND. roboteam-rem-v8:
// REM_RobotCommandTesting with useWheelPWMRef. Wheel order is the packet's own.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil {

struct RobotAddress {
  int id = 0;
  bool blue = true;  // team, for formats that tell
};

bool can_drive_by_duty(const RadioFormat& format);

// `first`: with what switches the robot to duties. False: the format refused (a duty beyond its range).
bool append_duty_frames(const RadioFormat& format, const RobotAddress& robot,
                        const std::array<double, 4>& duty_ratio, bool first, std::vector<std::uint8_t>& out);

}  // namespace omnihil
