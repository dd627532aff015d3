// RoboJackets: what their base station takes by UDP and passes on, robots' answers, and the wire to a motor board.
//
//   to a robot    trigger (2) · chip · robot (4) · team · x, y, w int16 · dribbler · strength · mode (6) · role (2)
//   from a robot  kicker (2) · ball · robot (4) · team · battery · unused (2) · FPGA · motors (5)
//   motor board   01 · int32 ticks/s · …  or  02 · p, i, d float;  back · int32 ticks/s
//
// All little-endian, bits from the lowest up. Source: RoboJackets/robocup-rustware 249a10e (radio/control_command.rs),
// 6c243db (radio/robot_status.rs), 0ecc2de (common/motor.rs); RoboJackets/robocup-base-station 02ac562.
#include <algorithm>
#include <array>
#include <cmath>

#include "protocols/codec.h"
#include "protocols/dongles/plain_dongle.h"
#include "protocols/field_rows.h"
#include "protocols/plain_packet.h"
#include "protocols/scale_rules.h"

namespace omnihil {
namespace {

constexpr Field speed(std::string_view name, std::string_view unit, std::string_view what) {
  return scaled(name, 16, Sign::kTwosComplement, kThousandths, -32.768, 32.767, unit, what);
}
constexpr std::array kWhom{
    with_role(FieldRole::kRobot, number("robot_id", 4, "", "the robot")),
    with_role(FieldRole::kTeamYellow, number("team", 1, "", "0 blue, 1 yellow")),
};
constexpr auto kControlRows = in_order(
    std::array{
        number("trigger_mode", 2, "", "0 the kicker stands down, 1 kick now, 2 when the ball is there"),
        flag("shoot_mode", "the kick is a chip")},
    kWhom,
    std::array{speed("body_x", "m/s", "velocity to the right"), speed("body_y", "m/s", "velocity forward"),
               speed("body_w", "rad/s", "yaw rate, anticlockwise seen from above"),
               signed_number("dribbler_speed", 8, "%", "share of full speed"),
               number("kick_strength", 8, "", "255 is 7 m/s"),
               number("mode", 6, "", "0 drives; 1 to 7 are tests of parts of the robot"),
               number("role", 2, "", "what the robot is to the team")});
constexpr auto kStatusRows = in_order(
    std::array{flag("kick_healthy", "the kicker works"), flag("kick_status", "the kicker is charged"),
               flag("ball_sense_status", "it has the ball")},
    kWhom,
    std::array{number("battery_voltage", 8, "", "counts of 0.09884 V"),
               enveloped(reserved("unused", 2, "sent as 0")), flag("fpga_status", "1: the FPGA has an error"),
               number("motor_errors", 5, "", "a bit for each motor and the dribbler")});

constexpr std::array kMoveRows{
    type_code("command", 8, "01"),
    signed_number("ticks_per_second", 32, "1/s", "speed wanted, in ticks of the encoder"),
    enveloped(reserved("rest", 64, "what the buffer held"))};
constexpr std::array kPidRows{type_code("command", 8, "02"), float32("kp", "", "of the speed loop"),
                              float32("ki", "", "of the speed loop"), float32("kd", "", "of the speed loop")};
constexpr std::array kReplyRows{
    enveloped(reserved("status", 8, "not written yet")),
    signed_number("ticks_per_second", 32, "1/s", "speed, in ticks of the encoder")};
constexpr auto kMove = in_order(kMoveRows);
constexpr auto kPid = in_order(kPidRows);
constexpr auto kReply = in_order(kReplyRows);

// Codes stand in the motor boards' commands alone; the others are told by their lengths.
enum Type : std::uint32_t { kMotorMove = 1, kMotorPid = 2, kStatus = 3, kMotorReply = 5, kControl = 10 };
constexpr Message row(std::string_view name, Type type, Direction direction, std::span<const Field> fields,
                      std::string_view what, MessageRole role = MessageRole::kNone) {
  const int bytes = (fields.back().bit + fields.back().bits) / 8;
  return {name, type, bytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
}
constexpr std::array kMessages{
    row("control_message", kControl, Direction::kToRobot, kControlRows, "Velocity, kick and dribbler.",
        MessageRole::kCommand),
    row("robot_status_message", kStatus, Direction::kFromRobot, kStatusRows, "A robot's answer to each.",
        MessageRole::kFeedback),
    row("motor_command_move", kMotorMove, Direction::kInside, kMove, "Speed of one motor."),
    row("motor_command_set_pid", kMotorPid, Direction::kInside, kPid, "Gains of one motor's speed loop."),
    row("motor_move_response", kMotorReply, Direction::kInside, kReply, "The motor board's answer."),
};
static_assert(all_tiled(kMessages));

constexpr double kKickStep_m_s = 7.0 / 255.0;  // robocup-software's packet_convert.cpp
constexpr double kBatteryStep_V = 0.09884;     // robocup-common's rtp.hpp
constexpr double kStandDown = 0, kNow = 1, kOnBall = 2;

RobotCommand to_command(const Values& values, int) {
  RobotCommand command{};
  if (values.number("mode") != 0.0) return command;
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = values.number("body_y");
  command.v_left_m_s = -values.number("body_x");
  command.omega_body_rad_s = values.number("body_w");
  command.dribbler_ratio = std::clamp(values.number("dribbler_speed") / 100.0, 0.0, 1.0);
  const double trigger = values.number("trigger_mode");
  if (trigger == kNow || trigger == kOnBall) {
    command.kick = values.flag("shoot_mode") ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = trigger == kNow ? OMNIHIL_KICK_NOW : OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = kKickStep_m_s * values.number("kick_strength");
  }
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  if (wanted.mode != OMNIHIL_MODE_BODY_VELOCITY || wanted.flags != 0) return false;
  if (to.robot_id < 0 || to.robot_id > 15) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when == OMNIHIL_KICK_AT_YAW || wanted.kick_pulse_s > 0.0)) return false;
  const double power = kicks ? std::trunc(wanted.v_kick_m_s / kKickStep_m_s) : 0.0;
  // Beyond its ends the host's own encoder would say less than is asked for.
  const double largest = std::max(
      {std::abs(wanted.v_forward_m_s), std::abs(wanted.v_left_m_s), std::abs(wanted.omega_body_rad_s)});
  if (!(largest <= 32.767) || !(power <= 255.0) || (kicks && power < 1.0)) return false;
  if (!(wanted.dribbler_ratio >= 0.0) || !(wanted.dribbler_ratio <= 1.0)) return false;
  Values values;
  values.message = message_of_type(kMessages, kControl);
  values.set("robot_id", to.robot_id);
  values.set("team", to.team == Team::kYellow ? 1.0 : 0.0);
  values.set("body_x", -wanted.v_left_m_s);
  values.set("body_y", wanted.v_forward_m_s);
  values.set("body_w", wanted.omega_body_rad_s);
  values.set("dribbler_speed", std::trunc(100.0 * wanted.dribbler_ratio));
  values.set("shoot_mode", wanted.kick == OMNIHIL_KICK_CHIP ? 1.0 : 0.0);
  values.set("trigger_mode", !kicks ? kStandDown : wanted.kick_when == OMNIHIL_KICK_NOW ? kNow : kOnBall);
  values.set("kick_strength", power);
  return encode_packet(values, out).error == PacketError::kNone;
}

bool answer(const Values& to_robot, int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kStatus);
  const auto is_set = [&](std::uint32_t flag) { return (feedback.flags & flag) != 0 ? 1.0 : 0.0; };
  out.set("robot_id", id);
  out.set("team", to_robot.number("team"));
  out.set("kick_healthy", 1.0);
  out.set("kick_status", is_set(OMNIHIL_FEEDBACK_CAPACITOR_CHARGED));
  out.set("ball_sense_status", is_set(OMNIHIL_FEEDBACK_BALL_SEEN));
  out.set("battery_voltage", std::clamp(std::floor(feedback.battery_V / kBatteryStep_V), 0.0, 255.0));
  return true;
}

constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t>) -> std::optional<std::size_t> { return 10; },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 500'000,
    .to_host_ns = 500'000,
    .to_command = to_command,
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "robojackets-2024",
    .title = "RoboJackets, base station and motor boards of 2024",
    .source =
        "https://github.com/RoboJackets/robocup-rustware at 249a10e, "
        "https://github.com/RoboJackets/robocup-base-station at 02ac562",
    .notes =
        "- The host sends one datagram of 10 bytes per robot to port 8000 of the base station, a Raspberry "
        "Pi with an "
        "nRF24L01; that sends each robot's answer, 3 bytes, to port 8000 of the host (10.42.0.1): `serve "
        "--device "
        "'udp:8000?listen=1'` answers whoever sends, so a host that sends from its port 8000 hears it.\n"
        "- Velocities are in the robot's frame, x to the right and y forward, as the host's own code for the "
        "simulator "
        "turns them; they are multiplied by 1000, cut off towards zero and held to int16.\n"
        "- No checksum: the radio has one.\n"
        "- The base station keeps the latest packet of each robot and sends all of them every 50 ms, waiting "
        "up to 5 ms "
        "for each answer; a host that falls silent leaves its last packets there. Here each is passed on at "
        "once, once.\n"
        "- The meaning of dribbler_speed and kick_strength is marked as undecided in the sources. Per cent "
        "is their "
        "latest word; 255 for 7 m/s is that of the host's converter. trigger_mode 3 is read as 0.\n"
        "- Counts of battery_voltage are of 0.09884 V in the robots before; the sources of these do not say. "
        "fpga_status is 0 for good there.\n"
        "- Base and robots also have packets to wake, to shut down and to list who is alive; their sources "
        "are not "
        "public.\n"
        "- A motor board (STM32F031) has a UART of its own; neither of its structs has a checksum. Answers "
        "to a test of "
        "the gains (4000 bytes of errors) are not spoken.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = 13,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_robojackets_2024() { return kFormat; }

}  // namespace omnihil
