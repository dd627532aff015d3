// The radio end of a RoboTeam robot: RobotFeedback -> REM telemetry, REM fields -> gains. Pure.
//
//   telemetry.robot_feedback(state, header, values);           // fills a REM_RobotFeedback
//
// Feedback's rho and theta are the body's velocity in the body frame, unlike a command's (rem_command.h).
// Values outside their range are set to the nearest end of it; angles are wrapped to -pi..pi.
#pragma once
#include <cstdint>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "protocols/radio_format.h"
#include "protocols/rem_command.h"

namespace omnihil::rem {

// Gains of the packet over `known`, for those that the packet does not carry.
RobotGains to_gains(const Values& values, const RobotGains& known);
// Does a command with these values ask for RobotStateInfo? v5 has no bit for it: always.
bool wants_state_info(const Values& values);

struct Header {
  int from_robot = 0;
  Team team = Team::kYellow;
  bool from_base_station = false;
  std::uint8_t message_id = 0;
  std::uint64_t time_ms = 0;  // Unix time
};

struct RobotState {
  RobotFeedback feedback{};
  RobotGains gains{};
  double omega_dribbler_before_ball_rad_s = 0.0;
};

class Telemetry {
 public:
  explicit Telemetry(const RadioFormat& format);

  void start(MessageRole role, const Header& header, Values& out) const;
  void robot_feedback(const RobotState& state, const Header& header, Values& out) const;
  void robot_state_info(const RobotState& state, const Header& header, Values& out) const;
  void robot_gains(const RobotState& state, const Header& header, Values& out) const;

 private:
  const RadioFormat& format_;
  bool centiseconds_ = false;           // v5's timestamp
  std::vector<int> state_info_fields_;  // place of each row of the state info's list; -1: not in this version
};

}  // namespace omnihil::rem
