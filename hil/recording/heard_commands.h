// What a host commanded in a recording: its bytes through the team's dongle, without robots or a loss on the air.
//
//   for (const HeardCommand& c : heard_commands(recording, format)) use(c.now_ns, c.robot_id, c.command);
//
// In the order of their times. Commands past the radio (a scenario's) are among them. Robots answer with silence's
// feedback, so that formats with a handshake have theirs.
#pragma once
#include <vector>

#include "hil/recording/recording.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct HeardCommand {
  std::int64_t now_ns = 0;
  int robot_id = 0;
  RobotCommand command{};
};

std::vector<HeardCommand> heard_commands(const Recording& recording, const RadioFormat& format);

}  // namespace omnihil
