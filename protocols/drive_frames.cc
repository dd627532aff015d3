#include "protocols/drive_frames.h"

#include <string>

namespace omnihil {
namespace {

using Duties = std::array<double, 4>;

bool append(const RadioFormat& format, const Values& values, std::vector<std::uint8_t>& out) {
  return format.encode(values, out).error == PacketError::kNone;
}

bool hermes_frames(const RadioFormat& format, const RobotAddress& robot, const Duties& duty, bool first,
                   std::vector<std::uint8_t>& out) {
  if (first) {
    Values loop;
    loop.message = format.find("SET_REGISTER");
    loop.set("robot", robot.id);
    loop.set("register", 0);  // control loop
    loop.set("value", 0);     // open
    if (!append(format, loop, out)) return false;
  }
  Values values;
  values.message = format.find("OPEN_LOOP_COMMAND");
  values.set("robot", robot.id);
  for (std::size_t i = 0; i < duty.size(); ++i) values.set("cmd[" + std::to_string(i) + "]", duty[i]);
  return append(format, values, out);
}

bool rem_frames(const RadioFormat& format, const RobotAddress& robot, const Duties& duty, bool,
                std::vector<std::uint8_t>& out) {
  Values values;
  values.message = format.find("REM_RobotCommandTesting");
  values.set("toRobotId", robot.id);
  values.set("toColor", robot.blue ? 1 : 0);
  values.set("fromPC", 1);
  values.set("useWheelPWMRef", 1);
  for (std::size_t i = 0; i < duty.size(); ++i) values.set("wheelPWM" + std::to_string(i + 1), duty[i]);
  return append(format, values, out);
}

using Frames = bool (*)(const RadioFormat&, const RobotAddress&, const Duties&, bool,
                        std::vector<std::uint8_t>&);

Frames frames_of(const RadioFormat& format) {
  if (format.find("OPEN_LOOP_COMMAND") != nullptr) return hermes_frames;
  if (format.find("REM_RobotCommandTesting") != nullptr) return rem_frames;
  return nullptr;
}

}  // namespace

bool can_drive_by_duty(const RadioFormat& format) { return frames_of(format) != nullptr; }

bool append_duty_frames(const RadioFormat& format, const RobotAddress& robot, const Duties& duty_ratio,
                        bool first, std::vector<std::uint8_t>& out) {
  const Frames frames = frames_of(format);
  return frames != nullptr && frames(format, robot, duty_ratio, first, out);
}

}  // namespace omnihil
