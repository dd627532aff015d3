#include "hil/league/robot_sights.h"

#include <cmath>

#include "hil/league/messages/ssl_vision.pb.h"

namespace omnihil {

std::vector<RobotSight> robot_sights(std::string_view datagram, Team team, std::optional<int> robot_id) {
  std::vector<RobotSight> sights;
  league::SSL_WrapperPacket packet;
  if (!packet.ParseFromArray(datagram.data(), static_cast<int>(datagram.size())) || !packet.has_detection())
    return sights;
  const league::SSL_DetectionFrame& frame = packet.detection();
  for (const league::SSL_DetectionRobot& robot :
       team == Team::kBlue ? frame.robots_blue() : frame.robots_yellow()) {
    const int id = static_cast<int>(robot.robot_id());
    if (!robot.has_robot_id() || (robot_id && id != *robot_id)) continue;
    if (!std::isfinite(robot.x() + robot.y() + robot.orientation())) continue;
    sights.push_back({frame.camera_id(), frame.t_capture(), frame.t_sent(), id, team, 1e-3 * robot.x(),
                      1e-3 * robot.y(), robot.orientation()});
  }
  return sights;
}

std::optional<FrameTimes> frame_times(std::string_view datagram) {
  league::SSL_WrapperPacket packet;
  if (!packet.ParseFromArray(datagram.data(), static_cast<int>(datagram.size())) || !packet.has_detection())
    return std::nullopt;
  const league::SSL_DetectionFrame& frame = packet.detection();
  return FrameTimes{frame.camera_id(), frame.t_capture(), frame.t_sent()};
}

}  // namespace omnihil
