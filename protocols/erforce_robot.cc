#include "protocols/erforce_robot.h"

#include <cmath>
#include <numbers>

#include "protocols/codec.h"
#include "protocols/teams/erforce_rows.h"

namespace omnihil::erforce {
namespace {

// shot_power has no unit in the sources: 255 is the fastest ball that the league allows.
constexpr double kKickStep_m_s = 6.5 / 255.0;
// battery is a share without a reference in the sources. Choice: six full lithium cells.
constexpr double kFullBattery_V = 25.2;

}  // namespace

RobotCommand to_command(const Values& values) {
  RobotCommand command{};
  if (values.flag("charge")) command.flags |= OMNIHIL_COMMAND_CHARGE;
  if (values.flag("standby")) return command;
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  const std::uint32_t kind = values.message->type;
  if (kind == kPath) {  // not followed: the velocity where it begins, the heading where it ends
    command.flags |= OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET;
    command.v_forward_m_s = values.number("trajectory.start_vel_x");
    command.v_left_m_s = values.number("trajectory.start_vel_y");
    command.yaw_target_rad = values.number("trajectory.end_phi");
  } else if (kind != kHalt) {  // the velocity at its time 0
    if (kind == kGlobalSpline) command.flags |= OMNIHIL_COMMAND_FIELD_FRAME;
    command.v_forward_m_s = values.number("trajectory.x_vel");
    command.v_left_m_s = values.number("trajectory.y_vel");
    command.omega_body_rad_s = values.number("trajectory.phi_vel");
  }
  const double power = values.number("shot_power");
  if (power > 0.0) {
    command.kick = values.flag("chip") ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = values.flag("force_kick") ? OMNIHIL_KICK_NOW : OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = kKickStep_m_s * power;
  }
  command.dribbler_ratio = std::fmax(values.number("dribbler"), 0.0);
  return command;
}

bool answer(std::span<const Message> messages, const Values& to_robot, const RobotFeedback& feedback,
            Values& out) {
  out.message = message_of_role(messages, MessageRole::kFeedback);
  const auto put = [&](std::string_view name, double number) {
    const auto i = static_cast<std::size_t>(out.message->field_index(name));
    out.fields[i] = nearest_value(out.message->fields[i], number);
  };
  const auto is_set = [&](std::uint32_t flag) { return (feedback.flags & flag) != 0 ? 1.0 : 0.0; };
  const double cosine = std::cos(feedback.yaw_rad), sine = std::sin(feedback.yaw_rad);
  put("counter", to_robot.number("counter"));
  put("battery", feedback.battery_V / kFullBattery_V);
  put("imu_status.error", 1.0 - is_set(OMNIHIL_FEEDBACK_IMU_READY));
  put("kicker_status.break_beam_error", 1.0 - is_set(OMNIHIL_FEEDBACK_BALL_SENSOR_OK));
  put("measured_phi", std::remainder(feedback.yaw_rad, 2.0 * std::numbers::pi));
  put("measured_vel_x", cosine * feedback.v_forward_m_s - sine * feedback.v_left_m_s);
  put("measured_vel_y", sine * feedback.v_forward_m_s + cosine * feedback.v_left_m_s);
  put("measured_omega", feedback.omega_body_rad_s);
  put("power_enabled", 1.0);
  put("ball_detected", is_set(OMNIHIL_FEEDBACK_BALL_SEEN));
  return true;
}

void remember(const Values& to_robot, std::uint32_t& kept, Values& answer) {
  if (to_robot.message->field_index("seqnum") >= 0) kept = to_robot.flag("seqnum") ? 0 : 1;
  answer.set("acknum", kept == 0 ? 1.0 : 0.0);
}

bool encode_command(const RadioFormat& format, const RobotCommand& wanted, std::vector<std::uint8_t>& out) {
  const bool drives = wanted.mode == OMNIHIL_MODE_BODY_VELOCITY;
  if (!drives && wanted.mode != OMNIHIL_MODE_COAST) return false;
  constexpr std::uint32_t kSaid = OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_CHARGE;
  if ((wanted.flags & ~kSaid) != 0 || !(std::abs(wanted.dribbler_ratio) <= 1.0)) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when == OMNIHIL_KICK_AT_YAW || wanted.kick_pulse_s > 0.0)) return false;
  const double power = kicks ? std::round(wanted.v_kick_m_s / kKickStep_m_s) : 0.0;
  if (!(power <= 255.0) || (kicks && power < 1.0)) return false;
  Values values;
  const bool in_field = (wanted.flags & OMNIHIL_COMMAND_FIELD_FRAME) != 0;
  values.message = message_of_type(format.messages, !drives    ? kHalt
                                                    : in_field ? kGlobalSpline
                                                               : kLocalSpline);
  values.set("acknum", 1.0);
  values.set("standby", drives ? 0.0 : 1.0);
  values.set("charge", (wanted.flags & OMNIHIL_COMMAND_CHARGE) != 0 ? 1.0 : 0.0);
  values.set("dribbler", wanted.dribbler_ratio);
  values.set("shot_power", power);
  values.set("chip", wanted.kick == OMNIHIL_KICK_CHIP ? 1.0 : 0.0);
  values.set("force_kick", kicks && wanted.kick_when == OMNIHIL_KICK_NOW ? 1.0 : 0.0);
  if (drives) {
    // Beyond their ends the team's encoder would say less than is asked for.
    const double largest = std::fmax(std::abs(wanted.v_forward_m_s), std::abs(wanted.v_left_m_s));
    if (!(largest <= 6.0) || !(std::abs(wanted.omega_body_rad_s) <= kFastestTurn_rad_s)) return false;
    values.set("trajectory.x_vel", wanted.v_forward_m_s);
    values.set("trajectory.y_vel", wanted.v_left_m_s);
    values.set("trajectory.phi_vel", wanted.omega_body_rad_s);
  }
  return format.encode(values, out).error == PacketError::kNone;
}

}  // namespace omnihil::erforce
