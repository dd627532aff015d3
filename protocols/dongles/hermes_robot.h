// The radio end of a RoboCup ULaval robot: HERMES packets -> SI commands and answers. Pure.
//
//   HermesRobot robot;
//   if (auto command = robot.receive(values, now_ns)) …      // for the firmware
//   robot.answer(robot_id, feedback, answer);                // `answer` is of the packet that the request's table names
//
// Facts (RobotMCU 44cc54f, hermes/commands.c and motors/ctrl_task.c): the control loop's state, set by
// SET_REGISTER and closed at the start, decides whether speeds or duties drive; each is forgotten 500 ms
// after it came; dribbler levels 0 to 3 are duties 0, 0.1, 0.2, 0.35; a kick charges, too.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include "firmware_iface/robot_io.h"
#include "protocols/radio_format.h"

namespace omnihil {

class HermesRobot {
 public:
  static constexpr std::int64_t kForget_ns = 500'000'000;

  // A packet from the host that reached this robot. Empty: it changes nothing that drives.
  std::optional<RobotCommand> receive(const Values& values, std::int64_t now_ns);

  // Fills an answer; out.message says which.
  void answer(int robot_id, const RobotFeedback& feedback, Values& out) const;

  std::uint32_t received() const { return received_; }

 private:
  RobotCommand command_now(std::int64_t now_ns) const;
  void set_register(int number, int value);

  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::min() / 2;
  bool open_loop_ = false;
  double v_forward_m_s_ = 0.0;
  double v_left_m_s_ = 0.0;
  double omega_body_rad_s_ = 0.0;
  std::int64_t speed_at_ns_ = kNever_ns;
  double duty_ratio_[OMNIHIL_WHEELS] = {};
  std::int64_t duty_at_ns_ = kNever_ns;
  bool charge_ = false;
  double dribbler_ratio_ = 0.0;
  double kick_pulse_s_ = 0.0;   // of the packet being received; a kick happens once
  std::uint32_t received_ = 0;  // packets, GET_NUM_REQUEST not counted
};

}  // namespace omnihil
