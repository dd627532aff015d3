// SSL A-Team's packets of 2026: RNP between host and robot (UDP), with eleven ways to say where to go.
//
//   CRC-32 · command · 0 · length of the payload · payload, all little-endian
//
// Source: SSL-A-Team/software-communication 81eddf4, SSL-A-Team/software ce3a440, SSL-A-Team/firmware abd05f5.
#include <algorithm>
#include <array>
#include <cmath>

#include "firmware_iface/checksum.h"
#include "protocols/codec.h"
#include "protocols/dongles/rnp_link.h"
#include "protocols/field_rows.h"
#include "protocols/plain_packet.h"

namespace omnihil {
namespace {

constexpr int kHeaderBytes = 8, kControlBytes = kHeaderBytes + 84;

constexpr ChecksumRule kCrc{.kind = &kCrc32, .from = 4};

constexpr Field zero(std::string_view name, int bits) { return enveloped(reserved(name, bits, "sent as 0")); }
constexpr Field letters(std::string_view name, int bits) {
  return reserved(name, bits, "letters of the line");
}
constexpr std::array kChecked{checksum("crc32", 32, "of everything after it", &kCrc)};
constexpr std::array kUnchecked{
    number("crc32", 32, "", "of everything after it; robots write 0 and the host does not look at it")};
constexpr std::array kCommandCode{type_code_bits("command_code", 8, 0, "what the packet is")};
constexpr std::array kAfterCommand{
    zero("header_reserved", 8), enveloped(length("data_length", 16, "bytes after the header", kHeaderBytes))};
constexpr auto kHead = in_order(kChecked, kCommandCode, kAfterCommand);
constexpr auto kRobotHead = in_order(kUnchecked, kCommandCode, kAfterCommand);

constexpr auto kEmpty = in_order(
    kChecked,
    std::array{number("command_code", 8, "", "1 acknowledged, 2 refused, 3 goodbye, 4 still there", 1, 4)},
    kAfterCommand);
constexpr auto kHelloRequest = in_order(
    kRobotHead,
    std::array{
        number("robot_id", 8, "", "the robot that looks for a host"),
        number("color", 8, "", "its team: 0 yellow, 1 blue"),
        flag("coms_dirty", "its packets are not those of a commit"),
        flag("controls_dirty", "its controls are not those of a commit"),
        flag("firmware_dirty", "its firmware is not that of a commit"),
        zero("flags_rest", 5),
        zero("padding", 8),
        number("coms_hash[0]", 8, "", "commit of its packets: the host refuses another than its own"),
        number("coms_hash[1]", 8, "", "commit of its packets: the host refuses another than its own"),
        number("coms_hash[2]", 8, "", "commit of its packets: the host refuses another than its own"),
        number("coms_hash[3]", 8, "", "commit of its packets: the host refuses another than its own"),
        number("controls_hash[0]", 8, "", "commit of its controls"),
        number("controls_hash[1]", 8, "", "commit of its controls"),
        number("controls_hash[2]", 8, "", "commit of its controls"),
        number("controls_hash[3]", 8, "", "commit of its controls"),
        number("firmware_hash[0]", 8, "", "commit of its firmware"),
        number("firmware_hash[1]", 8, "", "commit of its firmware"),
        number("firmware_hash[2]", 8, "", "commit of its firmware"),
        number("firmware_hash[3]", 8, "", "commit of its firmware"),
    });
constexpr auto kHelloResponse =
    in_order(kHead, std::array{number("ipv4[0]", 8, "", "address of the host"),
                               number("ipv4[1]", 8, "", "address of the host"),
                               number("ipv4[2]", 8, "", "address of the host"),
                               number("ipv4[3]", 8, "", "address of the host"),
                               number("port", 16, "", "UDP port of the host for this robot")});

// control: what all modes have, then 56 bytes by mode.
constexpr auto kControlHead = in_order(
    kHead, std::array{flag("request_shutdown", "switch off"), flag("request_reboot", "start anew"),
                      flag("game_in_stop", "the game is stopped"), flag("game_in_halt", "the game is halted"),
                      flag("emergency_stop", "stop now"), flag("wheel_vel_control", "wheels by speed"),
                      flag("wheel_torque_control", "wheels by torque"),
                      flag("vision_update", "the vision fields are of now"),
                      flag("reset_controller", "forget the controllers' states"), zero("flags_rest", 23),
                      float32("vision.x", "m", "place as vision sees it, x"),
                      float32("vision.y", "m", "place as vision sees it, y"),
                      float32("vision.yaw", "rad", "heading as vision sees it"),
                      type_code_bits("body_mode", 8, 8, "what the last 56 bytes mean"),
                      number("kick_request", 8, "",
                             "0 arm, 1 disable, 2 kick now, 3 kick at touch, 4 kick when captured, "
                             "5 to 7 the same as a chip"),
                      number("play_song", 8, "", "song to play; 0: none"),
                      number("dribbler_mode", 8, "",
                             "0 off, 1 hard receive, 2 soft receive, 3 dribble, 4 speed, 5 current"),
                      float32("kick_vel", "m/s", "speed of the ball"),
                      float32("dribbler_setpoint", "", "of modes 4 and 5")});
constexpr auto kOffRows =
    in_order(kControlHead,
             std::array{zero("rest[0]", 64), zero("rest[1]", 64), zero("rest[2]", 64), zero("rest[3]", 64),
                        zero("rest[4]", 64), zero("rest[5]", 64), zero("rest[6]", 64)});
constexpr auto kEstopBrakeRows =
    in_order(kControlHead,
             std::array{zero("rest[0]", 64), zero("rest[1]", 64), zero("rest[2]", 64), zero("rest[3]", 64),
                        zero("rest[4]", 64), zero("rest[5]", 64), zero("rest[6]", 64)});
constexpr auto kGlobalPositionRows = in_order(
    kControlHead,
    std::array{float32("command.x", "m", "place wanted, x"), float32("command.y", "m", "place wanted, y"),
               float32("command.theta", "rad", "heading wanted"),
               float32("command.max_linear_vel", "m/s", "largest speed"),
               float32("command.max_angular_vel", "rad/s", "largest yaw rate"),
               float32("command.max_linear_acc", "m/s^2", "largest acceleration"),
               float32("command.max_angular_acc", "rad/s^2", "largest of the yaw"), zero("rest[0]", 64),
               zero("rest[1]", 64), zero("rest[2]", 64), zero("rest[3]", 32)});
constexpr auto kGlobalVelocityRows = in_order(
    kControlHead,
    std::array{float32("command.xd", "m/s", "velocity, x"), float32("command.yd", "m/s", "velocity, y"),
               float32("command.omega", "rad/s", "yaw rate"),
               float32("command.max_linear_acc", "m/s^2", "largest acceleration"),
               float32("command.max_angular_acc", "rad/s^2", "largest of the yaw"), zero("rest[0]", 64),
               zero("rest[1]", 64), zero("rest[2]", 64), zero("rest[3]", 64), zero("rest[4]", 32)});
constexpr auto kLocalVelocityRows = in_order(
    kControlHead,
    std::array{float32("command.xd", "m/s", "velocity, x"), float32("command.yd", "m/s", "velocity, y"),
               float32("command.omega", "rad/s", "yaw rate"),
               float32("command.max_linear_acc", "m/s^2", "largest acceleration"),
               float32("command.max_angular_acc", "rad/s^2", "largest of the yaw"), zero("rest[0]", 64),
               zero("rest[1]", 64), zero("rest[2]", 64), zero("rest[3]", 64), zero("rest[4]", 32)});
constexpr auto kGlobalAccelRows =
    in_order(kControlHead, std::array{float32("command.xdd", "m/s^2", "acceleration, x"),
                                      float32("command.ydd", "m/s^2", "acceleration, y"),
                                      float32("command.alpha", "rad/s^2", "acceleration of the yaw"),
                                      zero("rest[0]", 64), zero("rest[1]", 64), zero("rest[2]", 64),
                                      zero("rest[3]", 64), zero("rest[4]", 64), zero("rest[5]", 32)});
constexpr auto kLocalAccelRows =
    in_order(kControlHead, std::array{float32("command.xdd", "m/s^2", "acceleration, x"),
                                      float32("command.ydd", "m/s^2", "acceleration, y"),
                                      float32("command.alpha", "rad/s^2", "acceleration of the yaw"),
                                      zero("rest[0]", 64), zero("rest[1]", 64), zero("rest[2]", 64),
                                      zero("rest[3]", 64), zero("rest[4]", 64), zero("rest[5]", 32)});
constexpr auto kHeadingPivotRows = in_order(
    kControlHead, std::array{float32("command.theta", "rad", "heading wanted"),
                             float32("command.max_vel", "rad/s", "largest yaw rate"),
                             float32("command.max_acc", "rad/s^2", "largest of the yaw"),
                             float32("command.radius", "m", "of the turn"),
                             float32("command.inset", "rad", "angle of the robot to the turn"),
                             number("command.direction", 8, "", "which way round"),
                             number("command.compute_inset", 8, "", "1: the robot chooses the inset"),
                             zero("command.padding", 16), zero("rest[0]", 64), zero("rest[1]", 64),
                             zero("rest[2]", 64), zero("rest[3]", 64)});
constexpr auto kPointPivotRows = in_order(
    kControlHead, std::array{float32("command.target_x", "m", "point to look at, x"),
                             float32("command.target_y", "m", "point to look at, y"),
                             float32("command.max_vel", "rad/s", "largest yaw rate"),
                             float32("command.max_acc", "rad/s^2", "largest of the yaw"),
                             float32("command.radius", "m", "of the turn"),
                             float32("command.inset", "rad", "angle of the robot to the turn"),
                             number("command.direction", 8, "", "which way round"),
                             number("command.compute_inset", 8, "", "1: the robot chooses the inset"),
                             zero("command.padding", 16), zero("rest[0]", 64), zero("rest[1]", 64),
                             zero("rest[2]", 64), zero("rest[3]", 32)});
constexpr auto kHeadingLineRows = in_order(
    kControlHead, std::array{float32("command.start_x", "m", "beginning of the line, x"),
                             float32("command.start_y", "m", "beginning of the line, y"),
                             float32("command.dir_x", "", "direction of the line, x"),
                             float32("command.dir_y", "", "direction of the line, y"),
                             float32("command.line_vel", "m/s", "speed along it"),
                             float32("command.theta", "rad", "heading wanted"),
                             float32("command.max_vel_colinear", "m/s", "largest along the line"),
                             float32("command.max_vel_perpendicular", "m/s", "largest across it"),
                             float32("command.max_vel_angular", "rad/s", "largest yaw rate"),
                             float32("command.max_acc_colinear", "m/s^2", "largest along the line"),
                             float32("command.max_acc_perpendicular", "m/s^2", "largest across it"),
                             float32("command.max_acc_angular", "rad/s^2", "largest of the yaw"),
                             float32("command.start_threshold", "m", "how near the beginning is near enough"),
                             zero("rest[0]", 32)});
constexpr auto kPointLineRows =
    in_order(kControlHead,
             std::array{float32("command.start_x", "m", "beginning of the line, x"),
                        float32("command.start_y", "m", "beginning of the line, y"),
                        float32("command.dir_x", "", "direction of the line, x"),
                        float32("command.dir_y", "", "direction of the line, y"),
                        float32("command.line_vel", "m/s", "speed along it"),
                        float32("command.target_x", "m", "point to look at, x"),
                        float32("command.target_y", "m", "point to look at, y"),
                        float32("command.max_vel_colinear", "m/s", "largest along the line"),
                        float32("command.max_vel_perpendicular", "m/s", "largest across it"),
                        float32("command.max_vel_angular", "rad/s", "largest yaw rate"),
                        float32("command.max_acc_colinear", "m/s^2", "largest along the line"),
                        float32("command.max_acc_perpendicular", "m/s^2", "largest across it"),
                        float32("command.max_acc_angular", "rad/s^2", "largest of the yaw"),
                        float32("command.start_threshold", "m", "how near the beginning is near enough")});

constexpr auto kTelemetry =
    in_order(kRobotHead, std::array{number("transmission_sequence", 8, "", "counts the robot's packets"),
                                    number("control_sequence", 8, "", "counts the controls it has had"),
                                    number("body_mode", 8, "", "of the latest control"),
                                    zero("padding", 8),
                                    flag("flags.power_error", "power"),
                                    flag("flags.power_board_error", "power board"),
                                    flag("flags.battery_error", "battery"),
                                    flag("flags.battery_low", "battery is low"),
                                    flag("flags.battery_crit", "battery is critical"),
                                    flag("flags.shutdown_pending", "it will switch off"),
                                    flag("flags.tipped_error", "it lies on its side"),
                                    flag("flags.breakbeam_error", "ball sensor does not work"),
                                    flag("flags.breakbeam_ball_detected", "ball sensor sees the ball"),
                                    flag("flags.accelerometer_0_error", "accelerometer 0"),
                                    flag("flags.accelerometer_1_error", "accelerometer 1"),
                                    flag("flags.gyroscope_0_error", "gyroscope 0"),
                                    flag("flags.gyroscope_1_error", "gyroscope 1"),
                                    flag("flags.motor_fl_general_error", "front left: any error"),
                                    flag("flags.motor_fl_hall_error", "front left: Hall sensors"),
                                    flag("flags.motor_bl_general_error", "back left: any error"),
                                    flag("flags.motor_bl_hall_error", "back left: Hall sensors"),
                                    flag("flags.motor_br_general_error", "back right: any error"),
                                    flag("flags.motor_br_hall_error", "back right: Hall sensors"),
                                    flag("flags.motor_fr_general_error", "front right: any error"),
                                    flag("flags.motor_fr_hall_error", "front right: Hall sensors"),
                                    flag("flags.motor_drib_general_error", "dribbler: any error"),
                                    flag("flags.motor_drib_hall_error", "dribbler: Hall sensors"),
                                    flag("flags.kicker_board_error", "kicker board"),
                                    flag("flags.chipper_available", "the chipper is ready"),
                                    flag("flags.kicker_available", "the kicker is ready"),
                                    flag("flags.controller_reset", "the controllers were reset"),
                                    zero("flags.rest", 5),
                                    number("battery_pct", 16, "%", "battery"),
                                    number("kicker_pct", 16, "%", "kicker's capacitor"),
                                    number("maneuver", 32, "", "where it is in a maneuver"),
                                    signed_number("position[0]", 16, "mm", "estimate, x"),
                                    signed_number("position[1]", 16, "mm", "estimate, y"),
                                    signed_number("position[2]", 16, "mrad", "estimate, heading"),
                                    signed_number("velocity[0]", 16, "mm/s", "estimate, x"),
                                    signed_number("velocity[1]", 16, "mm/s", "estimate, y"),
                                    signed_number("velocity[2]", 16, "mrad/s", "estimate, yaw rate")});

constexpr auto kErrorTelemetry = in_order(kRobotHead, std::array{
                                                          number("timestamp", 32, "", "of the robot"),
                                                          letters("message[0]", 64),
                                                          letters("message[1]", 64),
                                                          letters("message[2]", 64),
                                                          letters("message[3]", 64),
                                                          letters("message[4]", 64),
                                                          letters("message[5]", 64),
                                                          letters("message[6]", 64),
                                                          letters("message[7]", 32),
                                                      });

enum Type : std::uint32_t {
  kAlone = 0,
  kHello = 21,
  kHelloAnswer = 22,
  kState = 41,
  kError = 44,
  kDrive = 61,
};
enum Mode : std::uint32_t {
  kOff = 0,
  kEstopBrake = 1,
  kGlobalPosition = 10,
  kGlobalVelocity = 11,
  kLocalVelocity = 12,
  kGlobalAccel = 13,
  kLocalAccel = 14,
  kHeadingPivot = 20,
  kPointPivot = 21,
  kHeadingLine = 30,
  kPointLine = 31
};
constexpr Message row(std::string_view name, std::uint32_t type, int payload_bytes, Direction direction,
                      std::span<const Field> fields, std::string_view what,
                      MessageRole role = MessageRole::kNone) {
  return {name, type, kHeaderBytes + payload_bytes, false, direction, BitOrder::kLsbFirst, fields,
          what, role};
}
constexpr Message control(std::string_view name, Mode mode, std::span<const Field> fields,
                          std::string_view what) {
  return row(name, kDrive + 256u * mode, kControlBytes - kHeaderBytes, Direction::kToRobot, fields, what,
             MessageRole::kCommand);
}
using enum Direction;
constexpr std::array kMessages{
    row("empty", kAlone, 0, kBoth, kEmpty, "A header alone.", MessageRole::kHeaderOnly),
    row("hello_request", kHello, 16, kFromRobot, kHelloRequest, "A robot looks for a host."),
    row("hello_response", kHelloAnswer, 6, kToRobot, kHelloResponse,
        "The host answers: talk to this address."),
    control("control_off", kOff, kOffRows, "Body free."),
    control("control_estop_brake", kEstopBrake, kEstopBrakeRows, "Wheels braked."),
    control("control_global_position", kGlobalPosition, kGlobalPositionRows, "Go to a place."),
    control("control_global_velocity", kGlobalVelocity, kGlobalVelocityRows, "Velocity in the field frame."),
    control("control_local_velocity", kLocalVelocity, kLocalVelocityRows, "Velocity in the robot's frame."),
    control("control_global_accel", kGlobalAccel, kGlobalAccelRows, "Acceleration in the field frame."),
    control("control_local_accel", kLocalAccel, kLocalAccelRows, "Acceleration in the robot's frame."),
    control("control_heading_pivot", kHeadingPivot, kHeadingPivotRows, "Turn about a point to a heading."),
    control("control_point_pivot", kPointPivot, kPointPivotRows,
            "Turn about a point until it looks at another."),
    control("control_heading_line", kHeadingLine, kHeadingLineRows, "Follow a line with a heading."),
    control("control_point_line", kPointLine, kPointLineRows, "Follow a line and look at a point."),
    row("telemetry", kState, 28, kFromRobot, kTelemetry, "The robot's state in short.",
        MessageRole::kFeedback),
    row("error_telemetry", kError, 64, kFromRobot, kErrorTelemetry, "A line for people.", MessageRole::kText),
};
static_assert(all_tiled(kMessages));

RobotCommand to_command(const Values& control) {
  RobotCommand command{};
  const std::uint32_t mode = control.message->type >> 8;
  if (mode == kOff || control.flag("emergency_stop")) return command;
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  if (control.flag("vision_update")) {
    command.flags |= OMNIHIL_COMMAND_CAMERA_YAW;
    command.camera_yaw_rad = control.number("vision.yaw");
  }
  if (mode == kGlobalVelocity ||
      mode == kLocalVelocity) {  // all else stands still: the bench has no such goals
    if (mode == kGlobalVelocity) command.flags |= OMNIHIL_COMMAND_FIELD_FRAME;
    command.v_forward_m_s = control.number("command.xd");
    command.v_left_m_s = control.number("command.yd");
    command.omega_body_rad_s = control.number("command.omega");
  }
  if (control.flag("request_reboot")) command.flags |= OMNIHIL_COMMAND_REBOOT;
  const auto request = static_cast<int>(control.number("kick_request"));
  if (request != 1) command.flags |= OMNIHIL_COMMAND_CHARGE;
  if (request >= 2 && request <= 7) {
    command.kick = request <= 4 ? OMNIHIL_KICK_STRAIGHT : OMNIHIL_KICK_CHIP;
    command.kick_when = request == 2 || request == 5 ? OMNIHIL_KICK_NOW : OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = control.number("kick_vel");
  }
  const auto dribbler = static_cast<int>(control.number("dribbler_mode"));
  command.dribbler_ratio = dribbler >= 1 && dribbler <= 3 ? 1.0 : 0.0;
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  const bool drives = wanted.mode == OMNIHIL_MODE_BODY_VELOCITY;
  if (!drives && wanted.mode != OMNIHIL_MODE_COAST) return false;
  constexpr std::uint32_t kSaid =
      OMNIHIL_COMMAND_CHARGE | OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_CAMERA_YAW;
  if ((wanted.flags & ~kSaid) != 0) return false;
  if (wanted.dribbler_ratio != 0.0 && wanted.dribbler_ratio != 1.0) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when == OMNIHIL_KICK_AT_YAW || wanted.kick_pulse_s > 0.0)) return false;
  Values welcome;
  welcome.message = message_of_type(kMessages, kHelloAnswer);
  welcome.set("ipv4[0]", 127);
  welcome.set("ipv4[3]", 1);
  const bool in_field = (wanted.flags & OMNIHIL_COMMAND_FIELD_FRAME) != 0;
  const Mode mode = !drives ? kOff : in_field ? kGlobalVelocity : kLocalVelocity;
  Values control;
  control.message = message_of_type(kMessages, kDrive + 256u * mode);
  if (drives) {
    control.set("command.xd", wanted.v_forward_m_s);
    control.set("command.yd", wanted.v_left_m_s);
    control.set("command.omega", wanted.omega_body_rad_s);
  }
  control.set("vision_update", (wanted.flags & OMNIHIL_COMMAND_CAMERA_YAW) != 0 ? 1.0 : 0.0);
  control.set("vision.yaw", wanted.camera_yaw_rad);
  control.set("dribbler_mode", wanted.dribbler_ratio == 1.0 ? 3.0 : 0.0);
  control.set("kick_vel", kicks ? wanted.v_kick_m_s : 0.0);
  const double now = wanted.kick_when == OMNIHIL_KICK_NOW ? 0.0 : 1.0;
  const double disarmed = (wanted.flags & OMNIHIL_COMMAND_CHARGE) != 0 ? 0.0 : 1.0;
  control.set("kick_request", kicks ? (wanted.kick == OMNIHIL_KICK_CHIP ? 5.0 : 2.0) + now : disarmed);
  const std::size_t before = out.size();
  if (to.set_up && encode_packet(welcome, out).error != PacketError::kNone) return false;
  if (encode_packet(control, out).error == PacketError::kNone) return true;
  out.resize(before);
  return false;
}

void hello(int id, Team team, Values& out) {
  out.message = message_of_type(kMessages, kHello);
  out.set("robot_id", id);
  out.set("color", team == Team::kBlue ? 1.0 : 0.0);
}

void telemetry(const RobotFeedback& feedback, const Values* control, std::uint32_t sequence, Values& out) {
  out.message = message_of_type(kMessages, kState);
  const auto put = [&](std::string_view name, double number) {
    const auto i = static_cast<std::size_t>(out.message->field_index(name));
    out.fields[i] = nearest_value(out.message->fields[i], number);
  };
  const auto is_set = [&](std::uint32_t flag) { return (feedback.flags & flag) != 0 ? 1.0 : 0.0; };
  put("transmission_sequence", sequence % 256u);
  if (control != nullptr) put("body_mode", control->message->type >> 8);
  put("flags.breakbeam_error", 1.0 - is_set(OMNIHIL_FEEDBACK_BALL_SENSOR_OK));
  put("flags.breakbeam_ball_detected", is_set(OMNIHIL_FEEDBACK_BALL_SEEN));
  put("flags.gyroscope_0_error", 1.0 - is_set(OMNIHIL_FEEDBACK_IMU_READY));
  put("flags.kicker_available", is_set(OMNIHIL_FEEDBACK_KICKER_ON));
  put("position[2]", 1000.0 * feedback.yaw_rad);
  const double cosine = std::cos(feedback.yaw_rad), sine = std::sin(feedback.yaw_rad);
  put("velocity[0]", 1000.0 * (cosine * feedback.v_forward_m_s - sine * feedback.v_left_m_s));
  put("velocity[1]", 1000.0 * (sine * feedback.v_forward_m_s + cosine * feedback.v_left_m_s));
  put("velocity[2]", 1000.0 * feedback.omega_body_rad_s);
}

constexpr RnpDialect kDialect{
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      if (front.size() < kHeaderBytes) return std::nullopt;
      const std::size_t size = kHeaderBytes + front[6] + 256u * front[7];
      return size <= kControlBytes ? size : 0;  // the longest that a host sends
    },
    .hello = hello,
    .to_command = to_command,
    .telemetry = telemetry,
    .hello_answer = kHelloAnswer,
    .control = kDrive,
    .turns_away =
        [](const Values& packet) {
          if (packet.message->type != kAlone) return false;
          return packet.number("command_code") == 2.0 || packet.number("command_code") == 3.0;
        },
};

constinit const RadioFormat kFormat{
    .id = "ateam-rnp-2026",
    .title = "SSL A-Team RNP, 2026",
    .source =
        "https://github.com/SSL-A-Team/software-communication at 81eddf4, "
        "https://github.com/SSL-A-Team/software at ce3a440, https://github.com/SSL-A-Team/firmware at "
        "abd05f5",
    .notes =
        "- Discovery, handshake and time-outs are those of `ateam-rnp-stspin-2025`, but for the host's: it "
        "says "
        "goodbye after 500 ms of silence, 750 ms while it connects.\n"
        "- The table is transcribed from the headers; no packet made by the team's own program was compared "
        "with it.\n"
        "- The host refuses a robot whose coms_hash is not its own. The robots here send 0.\n"
        "- control is one packet with 56 bytes by body_mode; each mode has its table.\n"
        "- The CRC leaves itself out. The host always writes it; robots write 0 and the host does not look, "
        "so in "
        "packets of robots alone any number is taken.\n"
        "- Extended telemetry (command 42) and parameter packets (43) are not spoken. A branch of July 2026 "
        "has another header and the reverse of "
        "kick requests 0 and 1.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = kControlBytes,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = [](const RadioFormat& self,
                 const RadioLinkConfig& config) { return make_rnp_link(self, config, kDialect); },
};

}  // namespace

const RadioFormat& radio_format_ateam_rnp_2026() { return kFormat; }

}  // namespace omnihil
