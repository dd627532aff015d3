// What SSL-Vision says of one robot: each detection with the camera's own times.
//
//   for (const RobotSight& s : robot_sights(datagram, Team::kBlue, 3)) use(s.camera, s.x_m, s.sent_s);
//
// Nothing for a datagram that is no SSL_WrapperPacket, holds no detection, or does not see the robot.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "protocols/radio_link.h"

namespace omnihil {

struct RobotSight {
  unsigned camera = 0;
  double capture_s = 0.0, sent_s = 0.0;  // of the camera's clock
  int robot_id = 0;
  Team team = Team::kBlue;
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
};

// `robot_id` none: all of the team.
std::vector<RobotSight> robot_sights(std::string_view datagram, Team team, std::optional<int> robot_id);

// The times of a frame, whatever it sees; none: no detection.
struct FrameTimes {
  unsigned camera = 0;
  double capture_s = 0.0, sent_s = 0.0;
};
std::optional<FrameTimes> frame_times(std::string_view datagram);

}  // namespace omnihil
