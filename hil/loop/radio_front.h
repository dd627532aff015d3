// Commands to a firmware that decodes its radio's frames by itself: each as the frames that its format's dongle sends a
// robot, all of them at the instant of the command.
//
//   RadioFront front(*find_radio_format("ulaval-hermes"), robot_id, wheel_radius_m);
//   if (!front.say(command, firmware, now_ns)) …;      // the format cannot say this: nothing was sent
//
// What a host would write goes through the dongle of the format (Session's own, radio_link.h), on a clock of its own: how long
// the air takes is whose command it is, who has it in a latency of his own. Packets that have to go before the first command
// go before it; of a format that tells wheel speeds each asks for all that the robot can tell (hil/dataset/radio_ear.h hears
// it). A format that has velocities in the field's frame alone (REM) says them by the heading that is given.
// Cannot: keep a connection up for a format that wants packets between commands.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "firmware_iface/ports.h"
#include "protocols/radio_format.h"

namespace omnihil {

class RadioFront {
 public:
  RadioFront(const RadioFormat& format, int robot_id, double wheel_radius_m);
  // yaw_rad: heading in the field that the robot believes in.
  bool say(const RobotCommand& command, Firmware& firmware, std::int64_t now_ns, double yaw_rad = 0.0);

 private:
  const RadioFormat& format_;
  int robot_id_;
  bool tells_speeds_;
  std::unique_ptr<RadioLink> link_;
  std::int64_t clock_ns_ = 0;
  bool set_up_ = true;
  std::vector<std::uint8_t> bytes_;
};

// Appends the packets that say this, in the robot's frame or, where the format has no velocity there, in the field's. None: it
// cannot be said. Else: as it was said.
std::optional<RobotCommand> encode_towards(const RadioFormat& format, const RobotCommand& command,
                                           double yaw_rad, const CommandTo& to,
                                           std::vector<std::uint8_t>& out);

// Whether a host can say this in the format.
bool can_say(const RadioFormat& format, const RobotCommand& command);

}  // namespace omnihil
