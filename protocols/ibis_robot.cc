#include "protocols/ibis_robot.h"

#include <cmath>

#include "protocols/codec.h"
#include "protocols/plain_packet.h"
#include "protocols/teams/ibis_rows.h"

namespace omnihil::ibis {
namespace {

// kick_power has no unit of its own in the sources: 1 is the fastest ball that the league allows.
constexpr double kFullKick_m_s = 6.5;

constexpr double deg(double angle_rad) { return angle_rad * 180.0 / kPi; }
// What the 2026 main board writes in place of a sum.
constexpr double kWrittenChecksum = 10.0;

}  // namespace

RobotCommand to_command(const Values& values) {
  RobotCommand out{};
  if (values.flag("stop_emergency")) return out;
  out.mode = OMNIHIL_MODE_BODY_VELOCITY;
  out.flags = OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET;
  out.yaw_target_rad = values.number("target_global_theta");
  if (values.flag("is_vision_available")) {
    out.flags |= OMNIHIL_COMMAND_CAMERA_YAW;
    out.camera_yaw_rad = values.number("vision_global_theta");
  }
  if (values.message->type == kVelocityPolar) {
    const double speed_m_s = values.number("mode_args.target_global_velocity_r");
    const double direction_rad = values.number("mode_args.target_global_velocity_theta");
    out.v_forward_m_s = speed_m_s * std::cos(direction_rad);
    out.v_left_m_s = speed_m_s * std::sin(direction_rad);
  } else if (values.message->type != kPlace) {  // to a place: it stands still, nothing here knows where it is
    out.v_forward_m_s = values.number("mode_args.target_global_vel[0]");
    out.v_left_m_s = values.number("mode_args.target_global_vel[1]");
  }
  const double kick = values.number("kick_power");
  if (kick > 0.0) out.kick = values.flag("enable_chip") ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
  out.kick_when = OMNIHIL_KICK_ON_BALL;
  out.v_kick_m_s = kFullKick_m_s * kick;
  out.dribbler_ratio = std::fmin(values.number("dribble_power"), 1.0);
  return out;
}

bool encode_command(std::span<const Message> messages, const RobotCommand& wanted,
                    std::vector<std::uint8_t>& out, int robot_id) {
  const bool stop = wanted.mode == OMNIHIL_MODE_COAST;
  if (!stop && wanted.mode != OMNIHIL_MODE_BODY_VELOCITY) return false;
  Values values;
  values.message = message_of_type(messages, kVelocityXy);
  if (robot_id >= 0) values.set("robot_id", robot_id);
  values.set("stop_emergency", stop ? 1.0 : 0.0);
  if (!stop) {
    const bool stands = wanted.v_forward_m_s == 0.0 && wanted.v_left_m_s == 0.0;
    constexpr std::uint32_t kSaid =
        OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET | OMNIHIL_COMMAND_CAMERA_YAW;
    if ((wanted.flags & ~kSaid) != 0 || (wanted.flags & OMNIHIL_COMMAND_YAW_TARGET) == 0) return false;
    if (!stands && (wanted.flags & OMNIHIL_COMMAND_FIELD_FRAME) == 0) return false;
    if (wanted.kick != OMNIHIL_KICK_NONE &&
        (wanted.kick_when != OMNIHIL_KICK_ON_BALL || wanted.kick_pulse_s > 0.0)) {
      return false;
    }
    values.set("mode_args.target_global_vel[0]", wanted.v_forward_m_s);
    values.set("mode_args.target_global_vel[1]", wanted.v_left_m_s);
    values.set("target_global_theta", wanted.yaw_target_rad);
    values.set("is_vision_available", (wanted.flags & OMNIHIL_COMMAND_CAMERA_YAW) != 0 ? 1.0 : 0.0);
    values.set("vision_global_theta", wanted.camera_yaw_rad);
    values.set("dribble_power", wanted.dribbler_ratio);
    values.set("enable_chip", wanted.kick == OMNIHIL_KICK_CHIP ? 1.0 : 0.0);
    values.set("kick_power", wanted.kick == OMNIHIL_KICK_NONE ? 0.0 : wanted.v_kick_m_s / kFullKick_m_s);
  }
  for (const char* limit : {"acceleration_limit", "linear_velocity_limit", "angular_velocity_limit"}) {
    values.set(limit, kRange);
  }
  return encode_packet(values, out).error == PacketError::kNone;
}

bool answer(std::span<const Message> messages, const Values& to_robot, const RobotFeedback& feedback,
            Values& out) {
  out.message = message_of_type(messages, kState);
  const auto put = [&](std::string_view name, double number) {
    const auto i = static_cast<std::size_t>(out.message->field_index(name));
    out.fields[i] = nearest_value(out.message->fields[i], number);
  };
  const double cosine = std::cos(feedback.yaw_rad);
  const double sine = std::sin(feedback.yaw_rad);
  put("checksum", kWrittenChecksum);
  put("check_counter", to_robot.number("check_counter"));
  put("imu_yaw_deg", deg(std::remainder(feedback.yaw_rad, 2.0 * kPi)));
  put("diff_angle_deg",
      deg(std::remainder(feedback.yaw_rad - to_robot.number("vision_global_theta"), 2.0 * kPi)));
  put("battery_voltage_bldc_right", feedback.battery_V);
  put("capacitor_boost_voltage", feedback.capacitor_V);
  put("ball_detection[0]", (feedback.flags & OMNIHIL_FEEDBACK_BALL_SEEN) != 0 ? 1.0 : 0.0);
  put("vision_based_position_x", to_robot.number("vision_global_pos[0]"));
  put("vision_based_position_y", to_robot.number("vision_global_pos[1]"));
  put("global_odom_speed_x", cosine * feedback.v_forward_m_s - sine * feedback.v_left_m_s);
  put("global_odom_speed_y", sine * feedback.v_forward_m_s + cosine * feedback.v_left_m_s);
  put("tx_value_array[4]", feedback.body_target[0]);
  put("tx_value_array[5]", feedback.body_target[1]);
  constexpr std::string_view kMotors[] = {"tx_value_array[6]", "tx_value_array[7]", "tx_value_array[8]",
                                          "tx_value_array[9]"};
  for (std::size_t w = 0; w < OMNIHIL_WHEELS; ++w)
    put(kMotors[w], feedback.omega_wheel_rad_s[w] / (2.0 * kPi));
  put("tx_value_array[10]", feedback.v_forward_m_s);
  put("tx_value_array[11]", feedback.v_left_m_s);
  put("tx_value_array[12]", feedback.omega_body_rad_s);
  return true;
}

}  // namespace omnihil::ibis
