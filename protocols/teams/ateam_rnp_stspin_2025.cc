// SSL A-Team's packets of 2025: RNP between host and robot (UDP), and those on the wires to the wheels' controllers.
//
//   RNP     CRC-32 · version 0.1 · command · 0 · length of the payload · payload
//   STSPIN  type · 0 0 0 · CRC (0) · 44 or 48 bytes
//
// All little-endian, in the natural alignment of C.
// Source: SSL-A-Team/software-communication 0719fbf, SSL-A-Team/software 25d12cc9, SSL-A-Team/firmware f8968a4.
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

constexpr int kHeaderBytes = 12;

constexpr ChecksumRule kCrc{.kind = &kCrc32, .from = 4};

constexpr Field zero(std::string_view name, int bits) { return enveloped(reserved(name, bits, "sent as 0")); }
constexpr std::array kAfterCrc{
    enveloped(constant("version_major", 16, 0, "major version of the packets")),
    enveloped(constant("version_minor", 16, 1, "minor version of the packets")),
};
constexpr std::array kAfterCommand{
    zero("header_padding", 8), enveloped(length("data_length", 16, "bytes after the header", kHeaderBytes))};
constexpr std::array kChecked{checksum("crc32", 32, "of everything after it", &kCrc)};
constexpr std::array kUnchecked{
    number("crc32", 32, "", "of everything after it; robots write 0 and the host does not look at it")};
constexpr std::array kCommandCode{type_code("command_code", 8, "what the packet is")};
constexpr auto kHead = in_order(kChecked, kAfterCrc, kCommandCode, kAfterCommand);
constexpr auto kRobotHead = in_order(kUnchecked, kAfterCrc, kCommandCode, kAfterCommand);

constexpr auto kEmpty = in_order(
    kChecked, kAfterCrc,
    std::array{number("command_code", 8, "", "1 acknowledged, 2 refused, 3 goodbye, 4 still there", 1, 4)},
    kAfterCommand);
constexpr auto kHelloRequest =
    in_order(kRobotHead, std::array{number("robot_id", 8, "", "the robot that looks for a host"),
                                    number("color", 8, "", "its team: 0 yellow, 1 blue")});
constexpr auto kHelloResponse =
    in_order(kHead, std::array{number("ipv4[0]", 8, "", "address of the host"),
                               number("ipv4[1]", 8, "", "address of the host"),
                               number("ipv4[2]", 8, "", "address of the host"),
                               number("ipv4[3]", 8, "", "address of the host"),
                               number("port", 16, "", "UDP port of the host for this robot")});
constexpr auto kControl =
    in_order(kHead, std::array{float32("vel_x", "m/s", "velocity forward"),
                               float32("vel_y", "m/s", "velocity to the left"),
                               float32("vel_z", "rad/s", "yaw rate, anticlockwise seen from above"),
                               float32("kick_vel", "m/s", "speed of the ball"),
                               float32("dribbler_speed", "rpm", "speed of the dribbler"),
                               number("kick_request", 32, "",
                                      "0 arm, 1 disable, 2 kick now, 3 kick at touch, 4 kick when captured, "
                                      "5 to 7 the same as a chip")});
constexpr auto kTelemetry =
    in_order(kRobotHead, std::array{number("sequence", 16, "", "counts the robot's packets"),
                                    number("rev[0]", 8, "", "version of the robot, major"),
                                    number("rev[1]", 8, "", "version of the robot, minor"),
                                    float32("battery", "V", "battery"),
                                    float32("battery_temp", "deg C", "temperature of the battery"),
                                    flag("flags.power_error", "the power board reports an error"),
                                    flag("flags.tipped_error", "the robot lies on its side"),
                                    flag("flags.breakbeam_error", "the ball sensor does not work"),
                                    flag("flags.breakbeam_ball_detected", "the ball sensor sees the ball"),
                                    flag("flags.accelerometer_0_error", "accelerometer 0"),
                                    flag("flags.accelerometer_1_error", "accelerometer 1"),
                                    flag("flags.gyroscope_0_error", "gyroscope 0"),
                                    flag("flags.gyroscope_1_error", "gyroscope 1"),
                                    flag("flags.motor_0_general_error", "motor 0: any error"),
                                    flag("flags.motor_0_hall_error", "motor 0: Hall sensors"),
                                    flag("flags.motor_1_general_error", "motor 1: any error"),
                                    flag("flags.motor_1_hall_error", "motor 1: Hall sensors"),
                                    flag("flags.motor_2_general_error", "motor 2: any error"),
                                    flag("flags.motor_2_hall_error", "motor 2: Hall sensors"),
                                    flag("flags.motor_3_general_error", "motor 3: any error"),
                                    flag("flags.motor_3_hall_error", "motor 3: Hall sensors"),
                                    flag("flags.motor_4_general_error", "motor 4 (dribbler): any error"),
                                    flag("flags.motor_4_hall_error", "motor 4 (dribbler): Hall sensors"),
                                    flag("flags.chipper_available", "the chipper is ready"),
                                    flag("flags.kicker_available", "the kicker is ready"),
                                    reserved("flags.rest", 12, "not used"),
                                    float32("motor_temp[0]", "deg C", "temperature of motor 0"),
                                    float32("motor_temp[1]", "deg C", "temperature of motor 1"),
                                    float32("motor_temp[2]", "deg C", "temperature of motor 2"),
                                    float32("motor_temp[3]", "deg C", "temperature of motor 3"),
                                    float32("motor_temp[4]", "deg C", "temperature of motor 4 (dribbler)"),
                                    float32("kicker_charge", "V", "kicker's capacitor")});

constexpr std::string_view kMotorFlags =
    "bits from 0: master, Hall power, Hall disconnected, Hall transition, commutation watchdog, encoder "
    "disconnected, "
    "encoder decoding, Hall and encoder disagree, overcurrent, undervoltage, overvoltage, torque limited, "
    "loop time, "
    "reset by IWDG, WWDG, low power, software, pin";
constexpr auto kDebugTelemetry = in_order(
    kRobotHead,
    std::array{
        number("motor_fl.flags", 32, "", kMotorFlags),
        float32("motor_fl.vel_setpoint", "rad/s", "speed wanted"),
        float32("motor_fl.vel_setpoint_clamped", "rad/s", "the same within its slew rate"),
        signed_number("motor_fl.encoder_delta", 32, "rad/s", "unfiltered speed in whole rad/s, not ticks"),
        float32("motor_fl.vel_enc_estimate", "rad/s", "speed measured"),
        float32("motor_fl.vel_computed_error", "rad/s", "speed wanted less measured"),
        float32("motor_fl.vel_computed_setpoint", "", "what the speed loop asks for, duty -1 to 1"),
        float32("motor_fl.torque_setpoint", "N m", "torque wanted"),
        float32("motor_fl.current_estimate", "A", "current measured"),
        float32("motor_fl.torque_estimate", "N m", "torque measured"),
        float32("motor_fl.torque_computed_error", "N m", "torque wanted less measured"),
        float32("motor_fl.torque_computed_setpoint", "", "what the torque loop asks for"),
        number("motor_bl.flags", 32, "", kMotorFlags),
        float32("motor_bl.vel_setpoint", "rad/s", "speed wanted"),
        float32("motor_bl.vel_setpoint_clamped", "rad/s", "the same within its slew rate"),
        signed_number("motor_bl.encoder_delta", 32, "rad/s", "unfiltered speed in whole rad/s, not ticks"),
        float32("motor_bl.vel_enc_estimate", "rad/s", "speed measured"),
        float32("motor_bl.vel_computed_error", "rad/s", "speed wanted less measured"),
        float32("motor_bl.vel_computed_setpoint", "", "what the speed loop asks for, duty -1 to 1"),
        float32("motor_bl.torque_setpoint", "N m", "torque wanted"),
        float32("motor_bl.current_estimate", "A", "current measured"),
        float32("motor_bl.torque_estimate", "N m", "torque measured"),
        float32("motor_bl.torque_computed_error", "N m", "torque wanted less measured"),
        float32("motor_bl.torque_computed_setpoint", "", "what the torque loop asks for"),
        number("motor_br.flags", 32, "", kMotorFlags),
        float32("motor_br.vel_setpoint", "rad/s", "speed wanted"),
        float32("motor_br.vel_setpoint_clamped", "rad/s", "the same within its slew rate"),
        signed_number("motor_br.encoder_delta", 32, "rad/s", "unfiltered speed in whole rad/s, not ticks"),
        float32("motor_br.vel_enc_estimate", "rad/s", "speed measured"),
        float32("motor_br.vel_computed_error", "rad/s", "speed wanted less measured"),
        float32("motor_br.vel_computed_setpoint", "", "what the speed loop asks for, duty -1 to 1"),
        float32("motor_br.torque_setpoint", "N m", "torque wanted"),
        float32("motor_br.current_estimate", "A", "current measured"),
        float32("motor_br.torque_estimate", "N m", "torque measured"),
        float32("motor_br.torque_computed_error", "N m", "torque wanted less measured"),
        float32("motor_br.torque_computed_setpoint", "", "what the torque loop asks for"),
        number("motor_fr.flags", 32, "", kMotorFlags),
        float32("motor_fr.vel_setpoint", "rad/s", "speed wanted"),
        float32("motor_fr.vel_setpoint_clamped", "rad/s", "the same within its slew rate"),
        signed_number("motor_fr.encoder_delta", 32, "rad/s", "unfiltered speed in whole rad/s, not ticks"),
        float32("motor_fr.vel_enc_estimate", "rad/s", "speed measured"),
        float32("motor_fr.vel_computed_error", "rad/s", "speed wanted less measured"),
        float32("motor_fr.vel_computed_setpoint", "", "what the speed loop asks for, duty -1 to 1"),
        float32("motor_fr.torque_setpoint", "N m", "torque wanted"),
        float32("motor_fr.current_estimate", "A", "current measured"),
        float32("motor_fr.torque_estimate", "N m", "torque measured"),
        float32("motor_fr.torque_computed_error", "N m", "torque wanted less measured"),
        float32("motor_fr.torque_computed_setpoint", "", "what the torque loop asks for"),
        float32("imu_gyro[0]", "rad/s", "gyroscope, x"),
        float32("imu_gyro[1]", "rad/s", "gyroscope, y"),
        float32("imu_gyro[2]", "rad/s", "gyroscope, z"),
        float32("imu_accel[0]", "m/s^2", "accelerometer, x"),
        float32("imu_accel[1]", "m/s^2", "accelerometer, y"),
        float32("imu_accel[2]", "m/s^2", "accelerometer, z"),
        float32("commanded_body_velocity[0]", "m/s", "velocity the host asks for, x"),
        float32("commanded_body_velocity[1]", "m/s", "velocity the host asks for, y"),
        float32("commanded_body_velocity[2]", "rad/s", "velocity the host asks for, z"),
        float32("clamped_commanded_body_velocity[0]", "m/s", "the same within the limits, x"),
        float32("clamped_commanded_body_velocity[1]", "m/s", "the same within the limits, y"),
        float32("clamped_commanded_body_velocity[2]", "rad/s", "the same within the limits, z"),
        float32("cgkf_body_velocity_state_estimate[0]", "m/s", "velocity by the Kalman filter, x"),
        float32("cgkf_body_velocity_state_estimate[1]", "m/s", "velocity by the Kalman filter, y"),
        float32("cgkf_body_velocity_state_estimate[2]", "rad/s", "velocity by the Kalman filter, z"),
        float32("body_velocity_u[0]", "m/s", "velocity the controller asks for, x"),
        float32("body_velocity_u[1]", "m/s", "velocity the controller asks for, y"),
        float32("body_velocity_u[2]", "rad/s", "velocity the controller asks for, z"),
        float32("wheel_velocity_u[0]", "rad/s", "wheel speed asked for, wheel 0"),
        float32("wheel_velocity_u[1]", "rad/s", "wheel speed asked for, wheel 1"),
        float32("wheel_velocity_u[2]", "rad/s", "wheel speed asked for, wheel 2"),
        float32("wheel_velocity_u[3]", "rad/s", "wheel speed asked for, wheel 3"),
        float32("wheel_velocity_clamped_u[0]", "rad/s", "the same within the limits, wheel 0"),
        float32("wheel_velocity_clamped_u[1]", "rad/s", "the same within the limits, wheel 1"),
        float32("wheel_velocity_clamped_u[2]", "rad/s", "the same within the limits, wheel 2"),
        float32("wheel_velocity_clamped_u[3]", "rad/s", "the same within the limits, wheel 3"),
    });
constexpr auto kParameter = in_order(
    kHead,
    std::array{
        number("code", 8, "", "0 read, 1 write, 2 acknowledged, 3 no such name, 4 not of this kind"),
        number("format", 8, "", "0 number, 1 three, 2 four, 3 P I D, 4 P I D and two limits, 5 matrix of 25"),
        number("name", 8, "", "0 to 2 controller of x, y, yaw rate; 3 to 7 Kalman filter; 8 to 10 limits"),
        zero("padding", 8),
        float32("values[0]", "", "value 0 of the format"),
        float32("values[1]", "", "value 1 of the format"),
        float32("values[2]", "", "value 2 of the format"),
        float32("values[3]", "", "value 3 of the format"),
        float32("values[4]", "", "value 4 of the format"),
        float32("values[5]", "", "value 5 of the format"),
        float32("values[6]", "", "value 6 of the format"),
        float32("values[7]", "", "value 7 of the format"),
        float32("values[8]", "", "value 8 of the format"),
        float32("values[9]", "", "value 9 of the format"),
        float32("values[10]", "", "value 10 of the format"),
        float32("values[11]", "", "value 11 of the format"),
        float32("values[12]", "", "value 12 of the format"),
        float32("values[13]", "", "value 13 of the format"),
        float32("values[14]", "", "value 14 of the format"),
        float32("values[15]", "", "value 15 of the format"),
        float32("values[16]", "", "value 16 of the format"),
        float32("values[17]", "", "value 17 of the format"),
        float32("values[18]", "", "value 18 of the format"),
        float32("values[19]", "", "value 19 of the format"),
        float32("values[20]", "", "value 20 of the format"),
        float32("values[21]", "", "value 21 of the format"),
        float32("values[22]", "", "value 22 of the format"),
        float32("values[23]", "", "value 23 of the format"),
        float32("values[24]", "", "value 24 of the format"),
    });

// On the wire to a motor controller: 2 Mbaud, 8 bits and even parity, a pause between structs, no CRC.
constexpr std::array kWireHead{type_code("type", 8, "what the struct is"),
                               enveloped(type_code_bits("type_padding", 24, 8, "0: no datagram")),
                               enveloped(type_code_bits("crc", 32, 8, "not computed: 0"))};
constexpr auto kMotorMotion = in_order(
    kWireHead,
    std::array{flag("reset", "the controller restarts"), flag("enable_telemetry", "answer every 5 ms"),
               zero("flags", 30),
               number("motion_control_type", 8, "", "0 open loop, 1 speed, 2 torque, 3 both"),
               zero("control_padding", 24), float32("setpoint", "rad/s", "speed wanted; torque: N m"),
               zero("rest[0]", 64), zero("rest[1]", 64), zero("rest[2]", 64), zero("rest[3]", 64)});
constexpr std::array kMotorGains{
    float32("vel_pid_imax[0]", "", "speed loop: P"),
    float32("vel_pid_imax[1]", "", "speed loop: I"),
    float32("vel_pid_imax[2]", "", "speed loop: D"),
    float32("vel_pid_imax[3]", "", "speed loop: limit of I"),
    float32("cur_pid_imax[0]", "", "current loop: P"),
    float32("cur_pid_imax[1]", "", "current loop: I"),
    float32("cur_pid_imax[2]", "", "current loop: D"),
    float32("cur_pid_imax[3]", "", "current loop: limit of I"),
    number("cur_clamp", 16, "", "limit of the current"),
};
constexpr auto kMotorParams = in_order(
    kWireHead,
    std::array{number("flags", 32, "", "bits from 0: timestamp, four speed gains, four current gains, clamp"),
               number("timestamp", 32, "", "of the host")},
    kMotorGains, std::array{zero("end_padding", 16)});
constexpr auto kMotorMotionReply = in_order(
    kWireHead, std::array{
                   number("flags", 32, "", kMotorFlags),
                   float32("vel_setpoint", "rad/s", "speed wanted"),
                   float32("vel_setpoint_clamped", "rad/s", "the same within its slew rate"),
                   signed_number("encoder_delta", 32, "rad/s", "unfiltered speed in whole rad/s, not ticks"),
                   float32("vel_enc_estimate", "rad/s", "speed measured"),
                   float32("vel_computed_error", "rad/s", "speed wanted less measured"),
                   float32("vel_computed_setpoint", "", "what the speed loop asks for, duty -1 to 1"),
                   float32("torque_setpoint", "N m", "torque wanted"),
                   float32("current_estimate", "A", "current measured"),
                   float32("torque_estimate", "N m", "torque measured"),
                   float32("torque_computed_error", "N m", "torque wanted less measured"),
                   float32("torque_computed_setpoint", "", "what the torque loop asks for"),
               });
constexpr auto kMotorParamsReply = in_order(
    kWireHead,
    std::array{number("version[0]", 8, "", "firmware, major"), number("version[1]", 8, "", "firmware, minor"),
               number("version[2]", 16, "", "firmware, patch"),
               number("timestamp", 32, "", "that of the command")},
    kMotorGains,
    std::array{zero("end_padding", 16), number("wheel_img_hash[0]", 8, "", "hash of the image"),
               number("wheel_img_hash[1]", 8, "", "hash of the image"),
               number("wheel_img_hash[2]", 8, "", "hash of the image"),
               number("wheel_img_hash[3]", 8, "", "hash of the image")});

enum Type : std::uint32_t {
  kAlone = 0,
  kHello = 101,
  kState = 102,
  kDebug = 103,
  kParameters = 104,
  kDrive = 201,
  kHelloAnswer = 202,
  kWireParams = 0x20,
  kWireMotion = 0x21,
  kWireParamsReply = 0x80,
  kWireMotionReply = 0x81,
};
constexpr Message row(std::string_view name, Type type, int size_bytes, Direction direction,
                      std::span<const Field> fields, std::string_view what,
                      MessageRole role = MessageRole::kNone) {
  return {name, type, size_bytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
}
using enum Direction;
constexpr std::array kMessages{
    // First: seven zeros behind the type are no datagram, whose version stands there.
    row("uart_motor_command_motion", kWireMotion, 52, kInside, kMotorMotion,
        "Main board to motor: set-point."),
    row("uart_motor_command_params", kWireParams, 52, kInside, kMotorParams, "Main board to motor: gains."),
    row("uart_motor_response_motion", kWireMotionReply, 56, kInside, kMotorMotionReply,
        "Motor to main board: state."),
    row("uart_motor_response_params", kWireParamsReply, 56, kInside, kMotorParamsReply,
        "Motor to main board: gains."),
    row("empty", kAlone, 12, kBoth, kEmpty, "A header alone.", MessageRole::kHeaderOnly),
    row("hello_request", kHello, 14, kFromRobot, kHelloRequest, "A robot looks for a host."),
    row("hello_response", kHelloAnswer, 18, kToRobot, kHelloResponse,
        "The host answers: talk to this address."),
    row("control", kDrive, 36, kToRobot, kControl, "Body velocity, kick and dribbler.",
        MessageRole::kCommand),
    row("telemetry", kState, 52, kFromRobot, kTelemetry, "The robot's state in short.",
        MessageRole::kFeedback),
    row("control_debug_telemetry", kDebug, 308, kFromRobot, kDebugTelemetry,
        "The robot's controllers at length.", MessageRole::kStateInfo),
    row("robot_parameter_command", kParameters, 116, kBoth, kParameter,
        "Read or write a parameter, and the answer."),
};
static_assert(all_tiled(kMessages));

constexpr double kFastestDribbler_rpm = 12'000.0;  // choice: the largest that the sources name is full duty

RobotCommand to_command(const Values& control) {
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = control.number("vel_x");
  command.v_left_m_s = control.number("vel_y");
  command.omega_body_rad_s = control.number("vel_z");
  command.dribbler_ratio = std::clamp(control.number("dribbler_speed") / kFastestDribbler_rpm, 0.0, 1.0);
  const auto request = static_cast<int>(control.number("kick_request"));
  if (request != 1) command.flags = OMNIHIL_COMMAND_CHARGE;
  if (request >= 2 && request <= 7) {
    command.kick = request <= 4 ? OMNIHIL_KICK_STRAIGHT : OMNIHIL_KICK_CHIP;
    command.kick_when = request == 2 || request == 5 ? OMNIHIL_KICK_NOW : OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = control.number("kick_vel");
  }
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  if (wanted.mode != OMNIHIL_MODE_BODY_VELOCITY || (wanted.flags & ~OMNIHIL_COMMAND_CHARGE) != 0)
    return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when == OMNIHIL_KICK_AT_YAW || wanted.kick_pulse_s > 0.0)) return false;
  Values welcome;
  welcome.message = message_of_type(kMessages, kHelloAnswer);
  welcome.set("ipv4[0]", 127);
  welcome.set("ipv4[3]", 1);
  Values control;
  control.message = message_of_type(kMessages, kDrive);
  control.set("vel_x", wanted.v_forward_m_s);
  control.set("vel_y", wanted.v_left_m_s);
  control.set("vel_z", wanted.omega_body_rad_s);
  control.set("dribbler_speed", wanted.dribbler_ratio * kFastestDribbler_rpm);
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

void telemetry(const RobotFeedback& feedback, const Values*, std::uint32_t sequence, Values& out) {
  out.message = message_of_type(kMessages, kState);
  const auto put = [&](std::string_view name, double number) {
    const auto i = static_cast<std::size_t>(out.message->field_index(name));
    out.fields[i] = nearest_value(out.message->fields[i], number);
  };
  const auto is_set = [&](std::uint32_t flag) { return (feedback.flags & flag) != 0 ? 1.0 : 0.0; };
  put("sequence", sequence % 65'536u);
  put("battery", feedback.battery_V);
  put("flags.breakbeam_error", 1.0 - is_set(OMNIHIL_FEEDBACK_BALL_SENSOR_OK));
  put("flags.breakbeam_ball_detected", is_set(OMNIHIL_FEEDBACK_BALL_SEEN));
  put("flags.gyroscope_0_error", 1.0 - is_set(OMNIHIL_FEEDBACK_IMU_READY));
  put("flags.kicker_available", is_set(OMNIHIL_FEEDBACK_KICKER_ON));
  put("kicker_charge", feedback.capacitor_V);
}

// The body's controllers are parameters 0 to 2, P I D alone or with two limits, which stay what they are.
bool parameter(const Values& asked, RobotGains& gains, Values& out) {
  constexpr double kRead = 0, kWrite = 1, kDone = 2, kNoSuchName = 3, kOtherKind = 4;
  constexpr std::array<std::string_view, 3> kPlaces{"values[0]", "values[1]", "values[2]"};
  out = asked;
  out.set("crc32", 0.0);
  const auto name = static_cast<std::size_t>(asked.number("name"));
  const bool writes = asked.number("code") == kWrite;
  if (name >= 3 || (!writes && asked.number("code") != kRead)) {
    out.set("code", kNoSuchName);
    return false;
  }
  const double format = asked.number("format");
  if (writes && format != 3 && format != 4) {
    out.set("code", kOtherKind);
    return false;
  }
  const std::array<double*, 3> pid{&gains.p[name], &gains.i[name], &gains.d[name]};
  for (std::size_t k = 0; k < pid.size(); ++k) {
    if (writes) {
      *pid[k] = asked.number(kPlaces[k]);
    } else {
      out.set(kPlaces[k], static_cast<float>(*pid[k]));
    }
  }
  if (!writes) out.set("format", 3);
  out.set("code", kDone);
  return writes;
}

constexpr RnpDialect kDialect{
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      constexpr std::array<std::uint8_t, 4> kVersion{0, 0, 1, 0};
      for (std::size_t i = 4; i < std::min<std::size_t>(front.size(), 8); ++i) {
        if (front[i] != kVersion[i - 4]) return 0;
      }
      if (front.size() < kHeaderBytes) return std::nullopt;
      const std::size_t size = kHeaderBytes + front[10] + 256u * front[11];
      return size <= 308 ? size : 0;
    },
    .hello = hello,
    .to_command = to_command,
    .telemetry = telemetry,
    .parameter = parameter,
    .hello_answer = kHelloAnswer,
    .control = kDrive,
    .parameters = kParameters,
    .turns_away =
        [](const Values& packet) {
          if (packet.message->type != kAlone) return false;
          return packet.number("command_code") == 2.0 || packet.number("command_code") == 3.0;
        },
};

constinit const RadioFormat kFormat{
    .id = "ateam-rnp-stspin-2025",
    .title = "SSL A-Team RNP and motor UART, 2025",
    .source =
        "https://github.com/SSL-A-Team/software-communication at 0719fbf, "
        "https://github.com/SSL-A-Team/software at 25d12cc9, https://github.com/SSL-A-Team/firmware at "
        "f8968a4",
    .notes =
        "- A packet is one UDP datagram. The robot looks for a host with hello_request from port 42069 to "
        "multicast "
        "224.4.20.69, port 42069, every second; the host answers hello_response with an address and a port "
        "of its "
        "own for this robot, or refuses (id 16 and above, an id that is taken), or is silent (other team). "
        "Then both "
        "talk to each other alone.\n"
        "- No packet but hello_request names the robot: one wire is one robot.\n"
        "- Host: control 60 times a second, a goodbye after 250 ms of silence. Robot: telemetry 100 times a "
        "second; "
        "the wheels stop 0.2 s after the last control, the robot starts anew 1 s after the host's last "
        "packet.\n"
        "- The CRC leaves itself out. The host always writes it; robots write 0 and the host does not look, "
        "so in "
        "packets of robots alone any number is taken. In packets that go both ways it is checked.\n"
        "- The length must be the header and the payload of the command exactly. Byte 9 is padding.\n"
        "- encoder_delta is a speed. Unused values of a parameter may hold what was in the buffer before.\n"
        "- uart_motor_* are the structs between main board and motor controllers (2 Mbaud, even parity, a "
        "pause ends "
        "a struct); they never are on the radio. `--motor-bus` serves that wire.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = 308,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY),
    .dongle = [](const RadioFormat& self,
                 const RadioLinkConfig& config) { return make_rnp_link(self, config, kDialect); },
};

}  // namespace

const RadioFormat& radio_format_ateam_rnp_stspin_2025() { return kFormat; }

}  // namespace omnihil
