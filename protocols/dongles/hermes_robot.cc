#include "protocols/dongles/hermes_robot.h"

#include <algorithm>
#include <cmath>

#include "protocols/hermes_types.h"

namespace omnihil {
namespace {

using hermes::kCharge, hermes::kDribbler, hermes::kKick, hermes::kLoop;

// Duty of the dribbler's motor for levels 0 to 3; any other level stops it.
double dribbler_ratio(int level) {
  constexpr double kRatio[] = {0.0, 0.1, 0.2, 0.35};
  return level >= 0 && level <= 3 ? kRatio[level] : 0.0;
}

constexpr double kKickUnit_s = 1e-4;

}  // namespace

std::optional<RobotCommand> HermesRobot::receive(const Values& values, std::int64_t now_ns) {
  const std::uint32_t type = values.message->type;
  if (type != hermes::kGetNumRequest) ++received_;
  kick_pulse_s_ = 0.0;
  if (type == hermes::kSpeedMove || type == hermes::kSpeedMoveAdvance) {
    v_forward_m_s_ = values.number("vx");
    v_left_m_s_ = values.number("vy");
    omega_body_rad_s_ = values.number("vtheta");
    speed_at_ns_ = now_ns;
    if (type == hermes::kSpeedMove) return open_loop_ ? std::nullopt : std::optional(command_now(now_ns));
    kick_pulse_s_ = values.number("kick_force") * kKickUnit_s;
    charge_ = values.flag("charge") || kick_pulse_s_ > 0.0;
    dribbler_ratio_ = dribbler_ratio(static_cast<int>(values.number("dribbler")));
    return command_now(now_ns);
  }
  if (type == hermes::kOpenLoopCommand) {
    for (std::size_t i = 0; i < OMNIHIL_WHEELS; ++i) {
      duty_ratio_[i] =
          std::clamp(values.number(hermes::kDutyFields[i]), -1.0, 1.0);  // a bridge cannot do more
    }
    duty_at_ns_ = now_ns;
    return open_loop_ ? std::optional(command_now(now_ns)) : std::nullopt;
  }
  if (type == hermes::kSetRegister) {
    set_register(static_cast<int>(values.number("register")), static_cast<int>(values.number("value")));
    return command_now(now_ns);
  }
  return std::nullopt;
}

void HermesRobot::set_register(int number, int value) {
  if (number == kLoop && value <= 2) open_loop_ = value == 0;
  if (number == kKick) {
    // The firmware turns ms into 0.1 ms in one byte: more than 25 ms wraps.
    kick_pulse_s_ = static_cast<double>(value * 10 % 256) * kKickUnit_s;
    charge_ = charge_ || kick_pulse_s_ > 0.0;
  }
  if (number == kCharge) charge_ = true;  // the firmware does not look at the value
  if (number == kDribbler) dribbler_ratio_ = dribbler_ratio(value);
}

RobotCommand HermesRobot::command_now(std::int64_t now_ns) const {
  RobotCommand command{};
  if (open_loop_) {
    command.mode = OMNIHIL_MODE_WHEEL_DUTY;
    if (now_ns - duty_at_ns_ <= kForget_ns) std::copy_n(duty_ratio_, OMNIHIL_WHEELS, command.duty_ratio);
  } else {
    command.mode = OMNIHIL_MODE_BODY_VELOCITY;
    if (now_ns - speed_at_ns_ <= kForget_ns) {
      command.v_forward_m_s = v_forward_m_s_;
      command.v_left_m_s = v_left_m_s_;
      command.omega_body_rad_s = omega_body_rad_s_;
    }
  }
  if (charge_) command.flags |= OMNIHIL_COMMAND_CHARGE;
  command.dribbler_ratio = dribbler_ratio_;
  if (kick_pulse_s_ > 0.0) {
    command.kick = OMNIHIL_KICK_STRAIGHT;
    command.kick_when = OMNIHIL_KICK_ON_BALL;
    command.kick_pulse_s = kick_pulse_s_;
  }
  return command;
}

void HermesRobot::answer(int robot_id, const RobotFeedback& feedback, Values& out) const {
  out.set("robot", robot_id);
  if (out.message->type == hermes::kBatterieResponse) {
    // decivolts = trunc(10 V)
    const double decivolts = std::floor(feedback.battery_V * 10.0);
    out.set("decivolts", std::isfinite(decivolts) ? std::clamp(decivolts, 0.0, 255.0) : 0.0);
  } else if (out.message->type == hermes::kNumRequestResponse) {
    out.set("value", received_);
  }
}

}  // namespace omnihil
