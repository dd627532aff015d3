// ibis-ssl Orion: the 64-byte command that crane sends to a robot, and the 128 bytes that the robot sends back.
//
//   to a robot    header 00 · counter · vision, limits, powers · flags · mode · arguments · 00 … (big-endian)
//   from a robot  AB EA · sum · counter · state (little-endian)
//
// Source: ibis-ssl/crane cd015fe (crane_sender/robot_packet.h), ibis-ssl/G474_Orion_main c7c89ec
// (Core/Inc/robot_packet.h), ibis-ssl/Orion_CM4 28c3ca0 (robot_feedback_packet.py).
#include <array>
#include <cmath>
#include <numbers>

#include "protocols/codec.h"
#include "protocols/dongles/plain_dongle.h"
#include "protocols/field_rows.h"
#include "protocols/plain_packet.h"
#include "protocols/scale_rules.h"

namespace omnihil {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRange = 32.767;

constexpr Field word(std::string_view name, std::string_view unit, std::string_view what) {
  return scaled(name, 16, Sign::kNone, kAroundHalf, -kRange, kRange, unit, what);
}
constexpr Field angle(std::string_view name, std::string_view what) {
  return scaled(name, 16, Sign::kNone, kAroundHalf, -kPi, kPi, "rad", what);
}
constexpr Field power(std::string_view name, std::string_view what) {
  return scaled(name, 8, Sign::kNone, kTwentieths, 0.0, 12.75, "", what);
}

constexpr std::array kHead{
    number("header", 8, "", "0"),
    number("check_counter", 8, "", "counts up to 200 and begins again; the robot gives it back", 0, 200),
    word("vision_global_pos[0]", "m", "x on the field as vision sees it"),
    word("vision_global_pos[1]", "m", "y on the field as vision sees it"),
    angle("vision_global_theta", "heading as vision sees it"),
    angle("target_global_theta", "heading to hold"),
    power("kick_power", "strength of the kick, 0 to 1; 0: none"),
    power("dribble_power", "strength of the dribbler, 0 to 1"),
    word("acceleration_limit", "m/s^2", "largest acceleration"),
    word("linear_velocity_limit", "m/s", "largest speed"),
    word("angular_velocity_limit", "rad/s", "largest yaw rate"),
    number("latency_time_ms", 16, "ms", "age of what the host knows"),
    number("elapsed_time_ms_since_last_vision", 16, "ms", "since vision last saw the robot"),
    reserved("flags_6_7", 2, "not used"),
    flag("prioritize_accurate_acceleration", "keep the direction of the acceleration"),
    flag("prioritize_move", "moving comes before turning"),
    flag("stop_emergency", "stop now"),
    flag("lift_dribbler", "lift the dribbler"),
    flag("enable_chip", "the kick is a chip"),
    flag("is_vision_available", "the vision fields are of now"),
    type_code("control_mode", 8, "what the arguments mean"),
};
constexpr std::array kVelocity{
    word("mode_args.target_global_vel[0]", "m/s", "velocity wanted, field frame x"),
    word("mode_args.target_global_vel[1]", "m/s", "velocity wanted, field frame y"),
};

// What follows the arguments, up to byte 64: sent as 0.
constexpr Field rest(std::string_view name, int bits) { return enveloped(reserved(name, bits, "sent as 0")); }
constexpr std::array kRest24{rest("rest[0]", 64), rest("rest[1]", 64), rest("rest[2]", 64)};

constexpr auto kLocalCamera =
    in_order(kHead,
             std::array{word("mode_args.ball_pos[0]", "m", "the ball in the robot's camera, x"),
                        word("mode_args.ball_pos[1]", "m", "the ball in the robot's camera, y"),
                        word("mode_args.ball_vel[0]", "m/s", "velocity of the ball, x"),
                        word("mode_args.ball_vel[1]", "m/s", "velocity of the ball, y")},
             kVelocity, kRest24, std::array{rest("rest[3]", 32)});
constexpr auto kPosition =
    in_order(kHead,
             std::array{word("mode_args.target_global_pos[0]", "m", "place wanted on the field, x"),
                        word("mode_args.target_global_pos[1]", "m", "place wanted on the field, y"),
                        word("mode_args.terminal_velocity", "m/s", "speed wanted there")},
             kRest24, std::array{rest("rest[3]", 64), rest("rest[4]", 16)});
constexpr auto kSimpleVelocity =
    in_order(kHead, kVelocity, kRest24, std::array{rest("rest[3]", 64), rest("rest[4]", 32)});
constexpr auto kPolarVelocity =
    in_order(kHead,
             std::array{word("mode_args.target_global_velocity_r", "m/s", "speed wanted"),
                        word("mode_args.target_global_velocity_theta", "rad",
                             "its direction in the field frame; the range is 32.767, not pi")},
             kRest24, std::array{rest("rest[3]", 64), rest("rest[4]", 32)});

constexpr Field tx(std::string_view name, std::string_view unit, std::string_view what) {
  return float32(name, unit, what);
}
constexpr auto kFeedback = in_order(std::array{
    type_code_bits("sync0", 8, 0, "begins each packet"),
    type_code_bits("sync1", 8, 8, "begins each packet"),
    number("checksum", 8, "",
           "sum of bytes 3 to 127 by the receiver's tools; the main board writes 10, so nobody may check it"),
    number("check_counter", 8, "", "that of the latest command"),
    float32("imu_yaw_deg", "deg", "heading by the gyroscope"),
    float32("battery_voltage_bldc_right", "V", "battery at the right motor board"),
    number("ball_detection[0]", 8, "", "ball sensor"),
    number("ball_detection[1]", 8, "", "ball sensor"),
    number("ball_detection[2]", 8, "", "ball sensor"),
    number("kick_state_div10", 8, "", "a tenth of the kicker's counter"),
    number("current_error_id", 16, "", "board that reports an error; 0: none"),
    number("current_error_info", 16, "", "what it reports"),
    float32("current_error_value", "", "its value"),
    number("motor_current_x10[0]", 8, "0.1 A", "current of motor 0"),
    number("motor_current_x10[1]", 8, "0.1 A", "current of motor 1"),
    number("motor_current_x10[2]", 8, "0.1 A", "current of motor 2"),
    number("motor_current_x10[3]", 8, "0.1 A", "current of motor 3"),
    number("ball_detection_extra", 8, "", "fourth ball sensor"),
    number("temp_motor[0]", 8, "deg C", "temperature of motor 0"),
    number("temp_motor[1]", 8, "deg C", "temperature of motor 1"),
    number("temp_motor[2]", 8, "deg C", "temperature of motor 2"),
    number("temp_motor[3]", 8, "deg C", "temperature of motor 3"),
    number("temp_fet", 8, "deg C", "temperature of the bridges"),
    number("temp_coil[0]", 8, "deg C", "temperature of the kicker's coil"),
    number("temp_coil[1]", 8, "deg C", "temperature of the chipper's coil"),
    float32("diff_angle_deg", "deg", "heading by the gyroscope less that of vision"),
    float32("capacitor_boost_voltage", "V", "kicker's capacitor"),
    float32("vision_based_position_x", "m", "place on the field, x"),
    float32("vision_based_position_y", "m", "place on the field, y"),
    float32("global_odom_speed_x", "m/s", "velocity by the wheels, field frame x"),
    float32("global_odom_speed_y", "m/s", "velocity by the wheels, field frame y"),
    number("camera_pos_x_div2", 8, "2 px", "ball in the camera, x / 2"),
    number("camera_pos_y", 8, "px", "ball in the camera, y"),
    number("camera_radius_div4", 8, "4 px", "ball in the camera, radius / 4"),
    number("camera_fps", 8, "1/s", "pictures of the camera per second"),
    tx("tx_value_array[0]", "m", "optical mouse, x"),
    tx("tx_value_array[1]", "m", "optical mouse, y"),
    tx("tx_value_array[2]", "m/s", "velocity by the mouse, field frame x"),
    tx("tx_value_array[3]", "m/s", "velocity by the mouse, field frame y"),
    tx("tx_value_array[4]", "m/s", "velocity the controller asks for, x"),
    tx("tx_value_array[5]", "m/s", "velocity the controller asks for, y"),
    tx("tx_value_array[6]", "rev/s", "motor 0"),
    tx("tx_value_array[7]", "rev/s", "motor 1"),
    tx("tx_value_array[8]", "rev/s", "motor 2"),
    tx("tx_value_array[9]", "rev/s", "motor 3"),
    tx("tx_value_array[10]", "m/s", "velocity by the wheels, forward"),
    tx("tx_value_array[11]", "m/s", "velocity by the wheels, left"),
    tx("tx_value_array[12]", "rad/s", "yaw rate by the wheels"),
    tx("tx_value_array[13]", "", "quality of the mouse's picture"),
    reserved("reserved", 64, "not used"),
});

enum Mode : std::uint32_t { kLocal = 0, kPlace = 1, kVelocityXy = 2, kVelocityPolar = 3, kState = 0xEAAB };
constexpr Message command(std::string_view name, Mode mode, std::span<const Field> fields,
                          std::string_view what) {
  return {
      name, mode, 64, false, Direction::kToRobot, BitOrder::kMsbFirst, fields, what, MessageRole::kCommand};
}
constexpr std::array kMessages{
    command("LOCAL_CAMERA", kLocal, kLocalCamera, "Velocity, with the ball as the robot's camera sees it."),
    command("POSITION_TARGET", kPlace, kPosition, "Go to a place."),
    command("SIMPLE_VELOCITY_TARGET", kVelocityXy, kSimpleVelocity, "Velocity in the field frame."),
    command("POLAR_VELOCITY_TARGET", kVelocityPolar, kPolarVelocity,
            "Velocity in the field frame as speed and direction (Orion, 2026)."),
    Message{"FEEDBACK", kState, 128, false, Direction::kFromRobot, BitOrder::kLsbFirst, kFeedback,
            "The robot's answer to each command.", MessageRole::kFeedback},
};
static_assert(all_tiled(kMessages));

// kick_power has no unit of its own in the sources: 1 is the fastest ball that the league allows.
constexpr double kFullKick_m_s = 6.5;

RobotCommand to_command(const Values& values, int) {
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

bool encode_command(const RobotCommand& wanted, const CommandTo&, std::vector<std::uint8_t>& out) {
  const bool stop = wanted.mode == OMNIHIL_MODE_COAST;
  if (!stop && wanted.mode != OMNIHIL_MODE_BODY_VELOCITY) return false;
  Values values;
  values.message = message_of_type(kMessages, kVelocityXy);
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

constexpr double deg(double angle_rad) { return angle_rad * 180.0 / kPi; }
// What the 2026 main board writes in place of a sum.
constexpr double kWrittenChecksum = 10.0;

bool answer(const Values& to_robot, int, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kState);
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

// CM4 to main board: 72 bytes at 1 Mbaud; its loop looks at the network every millisecond. Back: 128 bytes.
constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t>) -> std::optional<std::size_t> { return 64; },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 1'000'000 + 72 * 10'000,
    .to_host_ns = 128 * 10'000,
    .to_command = to_command,
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "ibis-robot-command-v2",
    .title = "ibis-ssl Orion: RobotCommandV2 and its feedback",
    .source =
        "https://github.com/ibis-ssl/crane at cd015fe, https://github.com/ibis-ssl/G474_Orion_main at "
        "c7c89ec, https://github.com/ibis-ssl/Orion_CM4 at 28c3ca0",
    .notes =
        "- A command is one UDP datagram of 64 bytes to the robot's own address: 192.168.20.(100 + id), port "
        "12345; in crane's simulation localhost, port 50100 + id. It carries no robot number, so one wire is "
        "one "
        "robot: `serve --robots 3 --device 'udp:50103?listen=1'`. The feedback is a datagram of 128 bytes, "
        "in "
        "reality to multicast 224.5.20.(100 + id), port 50100 + id; here to whoever sends commands.\n"
        "- Commands are big-endian, the feedback is little-endian.\n"
        "- No checksum in a command. In the feedback, the receiver's tools define the sum of bytes 3 to 127 "
        "and "
        "the main board writes 10: it is passed on and never checked.\n"
        "- Numbers of 16 bits stand around 7FFFh. 0 is 7FFFh; the largest content, FFFFh, is one step beyond "
        "the range and comes back as it was.\n"
        "- Mode 3 is Orion's of 2026 (speed and direction). In crane of 2024 it was a velocity with a "
        "trajectory; those bytes would be read as a speed here.\n"
        "- The robot's CM4 hands a command on when its check_counter changes, looking every millisecond; the "
        "robot stops 0.5 s after the last one. It answers each with one feedback.\n"
        "- The heading is always given as an angle; there is no yaw rate.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = 128,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = [](const RadioFormat& self,
                 const RadioLinkConfig& config) { return make_plain_dongle(self, config, kDongle); },
};

}  // namespace

const RadioFormat& radio_format_ibis_robot_command_v2() { return kFormat; }

}  // namespace omnihil
