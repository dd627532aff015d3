// TIGERs Mannheim's base station: datagrams of one command byte and a packed struct, little-endian.
//
//   60 · robot · 05 · where vision sees it · skill · its data      what a robot shall do
//   60 · robot · 06 · its state                                    its answer
//   62, 65, 66, 67                                                 host, cameras, configuration, broadcast
//
// Source: layouts read in TIGERs-Mannheim/Firmware 1e48326 (its licence forbids commercial use: facts only).
#include <algorithm>
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

constexpr Field steps(std::string_view name, int bits, double step, std::string_view unit,
                      std::string_view what) {
  return scaled(name, bits, Sign::kNone, kNearest, 0.0, step * static_cast<double>((1 << bits) - 1), unit,
                what);
}
constexpr std::array kRobot{
    enveloped(type_code_bits("command", 8, 0, "60: for or from a robot")),
    with_role(FieldRole::kRobot, number("bot", 8, "", "the robot")),
};
constexpr auto kMatchHead = in_order(
    kRobot,
    std::array{enveloped(type_code_bits("app", 8, 8, "5: what a robot shall do")),
               signed_number("curPosition[0]", 16, "mm", "x as vision sees it; 32767 in all three: unseen"),
               signed_number("curPosition[1]", 16, "mm", "y as vision sees it"),
               signed_number("curPosition[2]", 16, "mrad", "heading as vision sees it"),
               number("posDelay", 8, "0.25 ms", "age of the position"),
               number("camId", 8, "", "camera that saw it"),
               number("flags", 8, "", "bits 0 to 4 song, 5 to 7 lights"),
               type_code_bits("skillId", 8, 16, "how it shall move")});
constexpr std::array kKick{
    steps("skill_in.kickSpeed", 9, 0.02, "m/s", "speed of the ball"),
    number("skill_in.kickDevice", 1, "", "0 straight, 1 chip"),
    number("skill_in.kickMode", 2, "", "0 off; when to kick"),
    steps("skill_in.dribbleSpeed", 6, 0.125, "m/s", "surface speed of the dribbler"),
    steps("skill_in.dribbleForce", 6, 0.25, "N", "force of the dribbler"),
};
constexpr std::array kVelocity{
    signed_number("skill_in.xyw[0]", 16, "mm/s", "velocity, x"),
    signed_number("skill_in.xyw[1]", 16, "mm/s", "velocity, y"),
    signed_number("skill_in.xyw[2]", 16, "mrad/s", "yaw rate"),
    number("skill_in.accMaxXY", 8, "10/255 m/s^2", "largest acceleration"),
    number("skill_in.accMaxW", 8, "100/255 rad/s^2", "largest of the yaw"),
    number("skill_in.jerkMaxXY", 8, "", "largest jerk"),
    number("skill_in.jerkMaxW", 8, "", "largest of the yaw"),
};
constexpr auto kEmergencyRows = in_order(kMatchHead);
constexpr auto kWheelRows =
    in_order(kMatchHead,
             std::array{signed_number("skill_in.wheel[0]", 16, "0.005 rad/s", "speed of wheel 0"),
                        signed_number("skill_in.wheel[1]", 16, "0.005 rad/s", "speed of wheel 1"),
                        signed_number("skill_in.wheel[2]", 16, "0.005 rad/s", "speed of wheel 2"),
                        signed_number("skill_in.wheel[3]", 16, "0.005 rad/s", "speed of wheel 3")},
             kKick);
constexpr auto kVelocityRows = in_order(kMatchHead, kVelocity, kKick);
constexpr auto kPositionRows =
    in_order(kMatchHead,
             std::array{signed_number("skill_in.xyw[0]", 16, "mm", "place wanted, x"),
                        signed_number("skill_in.xyw[1]", 16, "mm", "place wanted, y"),
                        signed_number("skill_in.xyw[2]", 16, "mrad", "heading wanted"),
                        number("skill_in.velMaxXY", 8, "5/255 m/s", "largest speed"),
                        number("skill_in.velMaxW", 8, "30/255 rad/s", "largest yaw rate"),
                        number("skill_in.accMaxXY", 8, "10/255 m/s^2", "largest acceleration"),
                        number("skill_in.accMaxW", 8, "100/255 rad/s^2", "largest of the yaw")},
             kKick,
             std::array{signed_number("skill_in.primaryDirection", 8, "",
                                      "direction that comes first; -128: both together")});

constexpr auto kFeedback =
    in_order(kRobot, std::array{
                         enveloped(type_code_bits("app", 8, 8, "6: a robot's state")),
                         signed_number("curPosition[0]", 16, "mm", "x; 32767: unknown"),
                         signed_number("curPosition[1]", 16, "mm", "y"),
                         signed_number("curPosition[2]", 16, "mrad", "heading"),
                         signed_number("curVelocity[0]", 16, "mm/s", "velocity, x"),
                         signed_number("curVelocity[1]", 16, "mm/s", "velocity, y"),
                         signed_number("curVelocity[2]", 16, "mrad/s", "yaw rate"),
                         number("kickerLevel", 8, "V", "kicker's capacitor"),
                         number("kickerMax", 8, "V", "what it is charged to"),
                         number("dribblerState", 8, "", "state of the dribbler"),
                         number("batteryLevel", 8, "0.1 V", "battery"),
                         number("batteryPercent", 8, "1/255", "battery"),
                         number("flags", 8, "", "state of the robot"),
                         number("features", 16, "", "what it can do"),
                         number("hardwareId", 8, "", "of its board"),
                         number("ballPosAge", 8, "ms", "since it last saw the ball"),
                         signed_number("ballPosition[0]", 16, "mm", "ball, x"),
                         signed_number("ballPosition[1]", 16, "mm", "ball, y"),
                         number("lastKickDuration", 8, "0.05 ms", "time the kicker was on"),
                         number("lastKickDribbleVelDev", 8, "", "how far the dribbler was from its speed"),
                         number("lastKickDribbleForce", 8, "0.0625 N", "force of the dribbler at the kick"),
                     });
constexpr std::array kCommand{enveloped(type_code_bits("command", 8, 0, "what the datagram is"))};
constexpr auto kBroadcast = in_order(
    kCommand,
    std::array{
        number("baseStationId", 8, "", "of the base station"),
        number("allocatedBotIds", 32, "", "a bit for each robot that it serves"),
        number("unixTime", 32, "s", "the host's clock"), number("flags", 8, "", "state of the game"),
        signed_number("ballPosition[0]", 16, "mm", "ball, x"),
        signed_number("ballPosition[1]", 16, "mm", "ball, y"),
        number("ballPosDelay", 8, "0.25 ms", "age of it"), number("ballCamId", 8, "", "camera that saw it"),
        number("fieldSize[0]", 8, "", "with the next byte and a half: length 12 bits, width 12 bits, cm"),
        number("fieldSize[1]", 8, "", "see before"), number("fieldSize[2]", 8, "", "see before"),
        number("boundaryWidth", 8, "cm", "around the field"), number("goalWidth", 8, "cm", "of the goal"),
        number("goalDepth", 8, "cm", "of the goal")});
constexpr auto kAuth =
    in_order(kCommand, std::array{enveloped(constant("key", 32, 0x42424242, "the same for all"))});
constexpr auto kPing = in_order(kCommand);
constexpr auto kConfig = in_order(
    kCommand, std::array{number("visionIp[0]", 8, "", "multicast group of vision"),
                         number("visionIp[1]", 8, "", "multicast group of vision"),
                         number("visionIp[2]", 8, "", "multicast group of vision"),
                         number("visionIp[3]", 8, "", "multicast group of vision"),
                         number("visionPort", 16, "", "its port"), number("channel", 8, "", "radio channel"),
                         number("maxBots", 8, "", "robots at most"),
                         number("fixedRuntime", 8, "", "1: the time slots do not shrink")});
constexpr auto kViewport = in_order(kCommand, std::array{number("camId", 8, "", "the camera"),
                                                         signed_number("minX", 16, "mm", "what it sees"),
                                                         signed_number("minY", 16, "mm", "what it sees"),
                                                         signed_number("maxX", 16, "mm", "what it sees"),
                                                         signed_number("maxY", 16, "mm", "what it sees")});

enum Skill : std::uint32_t { kEmergency = 0, kWheels = 1, kLocal = 2, kGlobal = 3, kPlace = 4 };
constexpr std::uint32_t kMatch = 0x0560, kState = 0x0660;
constexpr Message row(std::string_view name, std::uint32_t type, int size_bytes, Direction direction,
                      std::span<const Field> fields, std::string_view what,
                      MessageRole role = MessageRole::kNone) {
  return {name, type, size_bytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
}
constexpr Message match(std::string_view name, Skill skill, int size_bytes, std::span<const Field> fields,
                        std::string_view what) {
  return row(name, kMatch + 0x10000u * skill, size_bytes, Direction::kToRobot, fields, what,
             MessageRole::kCommand);
}
using enum Direction;
constexpr std::array kMessages{
    match("emergency", kEmergency, 13, kEmergencyRows, "Wheels free."),
    match("wheel_vel", kWheels, 24, kWheelRows, "Speed of each wheel."),
    match("local_vel", kLocal, 26, kVelocityRows, "Velocity in the robot's frame."),
    match("global_vel", kGlobal, 26, kVelocityRows, "Velocity in the field frame."),
    match("global_pos", kPlace, 27, kPositionRows, "Go to a place."),
    row("match_feedback", kState, 32, kFromRobot, kFeedback, "A robot's answer.", MessageRole::kFeedback),
    row("broadcast", 0x67, 23, kToDongle, kBroadcast, "For all robots: ball, field, clock."),
    row("ping", 0x61, 1, kToDongle, kPing, "Given back."),
    row("auth", 0x62, 5, kToDongle, kAuth, "From now on the base station talks to this host."),
    row("config_v3", 0x66, 10, kToDongle, kConfig, "Vision, channel, number of robots."),
    row("cam_viewport", 0x65, 10, kToDongle, kViewport, "What a camera sees."),
};
static_assert(all_tiled(kMessages));

constexpr std::string_view kWheelFields[] = {"skill_in.wheel[0]", "skill_in.wheel[1]", "skill_in.wheel[2]",
                                             "skill_in.wheel[3]"};
constexpr std::string_view kXyw[] = {"skill_in.xyw[0]", "skill_in.xyw[1]", "skill_in.xyw[2]"};
constexpr double kWheelStep_rad_s = 0.005;
constexpr double kFullDribbler_m_s = 63 * 0.125;

RobotCommand to_command(const Values& values, int) {
  RobotCommand command{};
  const std::uint32_t skill = values.message->type >> 16;
  if (skill == kEmergency) return command;
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  if (skill == kWheels) {
    command.mode = OMNIHIL_MODE_WHEEL_SPEED;
    for (std::size_t w = 0; w < OMNIHIL_WHEELS; ++w) {
      command.omega_wheel_rad_s[w] = kWheelStep_rad_s * values.number(kWheelFields[w]);
    }
  } else if (skill != kPlace) {  // to a place: it stands still, nothing here knows where it is
    if (skill == kGlobal) command.flags = OMNIHIL_COMMAND_FIELD_FRAME;
    command.v_forward_m_s = values.number(kXyw[0]) / 1000.0;
    command.v_left_m_s = values.number(kXyw[1]) / 1000.0;
    command.omega_body_rad_s = values.number(kXyw[2]) / 1000.0;
  }
  if (values.number("skill_in.kickMode") != 0.0) {
    command.kick = values.flag("skill_in.kickDevice") ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = values.number("skill_in.kickSpeed");
  }
  command.dribbler_ratio = values.number("skill_in.dribbleSpeed") / kFullDribbler_m_s;
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  const bool wheels = wanted.mode == OMNIHIL_MODE_WHEEL_SPEED;
  const bool stop = wanted.mode == OMNIHIL_MODE_COAST;
  if (!wheels && !stop && wanted.mode != OMNIHIL_MODE_BODY_VELOCITY) return false;
  if ((wanted.flags & ~OMNIHIL_COMMAND_FIELD_FRAME) != 0) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when != OMNIHIL_KICK_ON_BALL || wanted.kick_pulse_s > 0.0 || stop)) return false;
  if (stop && wanted.dribbler_ratio != 0.0) return false;
  const bool in_field = (wanted.flags & OMNIHIL_COMMAND_FIELD_FRAME) != 0;
  const Skill skill = stop ? kEmergency : wheels ? kWheels : in_field ? kGlobal : kLocal;
  Values values;
  values.message = message_of_type(kMessages, kMatch + 0x10000u * skill);
  values.set("bot", to.robot_id);
  for (const char* unseen : {"curPosition[0]", "curPosition[1]", "curPosition[2]"})
    values.set(unseen, 32'767);
  if (wheels) {
    for (std::size_t w = 0; w < OMNIHIL_WHEELS; ++w) {
      values.set(kWheelFields[w], std::round(wanted.omega_wheel_rad_s[w] / kWheelStep_rad_s));
    }
  } else if (!stop) {
    values.set(kXyw[0], std::round(1000.0 * wanted.v_forward_m_s));
    values.set(kXyw[1], std::round(1000.0 * wanted.v_left_m_s));
    values.set(kXyw[2], std::round(1000.0 * wanted.omega_body_rad_s));
    for (const char* limit :
         {"skill_in.accMaxXY", "skill_in.accMaxW", "skill_in.jerkMaxXY", "skill_in.jerkMaxW"}) {
      values.set(limit, 255);
    }
  }
  if (!stop) {
    values.set("skill_in.kickMode", kicks ? 1.0 : 0.0);
    values.set("skill_in.kickDevice", wanted.kick == OMNIHIL_KICK_CHIP ? 1.0 : 0.0);
    values.set("skill_in.kickSpeed", kicks ? wanted.v_kick_m_s : 0.0);
    values.set("skill_in.dribbleSpeed", wanted.dribbler_ratio * kFullDribbler_m_s);
  }
  return encode_packet(values, out).error == PacketError::kNone;
}

bool answer(const Values&, int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kState);
  const auto put = [&](std::string_view name, double number) {
    const auto i = static_cast<std::size_t>(out.message->field_index(name));
    out.fields[i] = nearest_value(out.message->fields[i], number);
  };
  const double cosine = std::cos(feedback.yaw_rad), sine = std::sin(feedback.yaw_rad);
  put("bot", id);
  put("curPosition[0]", 32'767);
  put("curPosition[1]", 32'767);
  put("curPosition[2]", 1000.0 * std::remainder(feedback.yaw_rad, 2.0 * std::numbers::pi));
  put("curVelocity[0]", 1000.0 * (cosine * feedback.v_forward_m_s - sine * feedback.v_left_m_s));
  put("curVelocity[1]", 1000.0 * (sine * feedback.v_forward_m_s + cosine * feedback.v_left_m_s));
  put("curVelocity[2]", 1000.0 * feedback.omega_body_rad_s);
  put("kickerLevel", feedback.capacitor_V);
  put("batteryLevel", 10.0 * feedback.battery_V);
  return true;
}

// A datagram's length, by its command; a robot's by its skill as well.
std::optional<std::size_t> frame_bytes(std::span<const std::uint8_t> front) {
  bool may_be = false;
  for (const Message& message : kMessages) {
    if (has_type_of(message, front)) return static_cast<std::size_t>(message.size_bytes);
    may_be = may_be || (message.type & 0xFFu) == front[0];
  }
  return may_be && front.size() < 13 ? std::nullopt : std::optional<std::size_t>(0);
}

constexpr PlainDongle kDongle{
    .frame_bytes = frame_bytes,
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 1'000'000,
    .to_host_ns = 1'000'000,
    .to_command = to_command,
    .dongle_answer =
        [](const Values& asked, Values& out) {
          out = asked;
          return asked.message->name == "ping";
        },
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "tigers-base-station",
    .title = "TIGERs Mannheim base station",
    .source = "layouts (facts) read in https://github.com/TIGERs-Mannheim/Firmware at 1e48326",
    .notes =
        "- One UDP datagram is one packet; the base station is 192.168.1.210, port 10201. "
        "`serve --device 'udp:10201?listen=1'`.\n"
        "- What a robot shall do is one packet with data by skill; each skill has its table.\n"
        "- curPosition is 32767 in all three where vision does not see the robot.\n"
        "- Limits are shares of the largest value, 255 being all of it.\n"
        "- auth, config_v3, cam_viewport and broadcast are taken and change nothing here. ping is read "
        "without a "
        "payload. Statistics of the base station (64h and 68h, ten times a second) are not sent: their "
        "fields are "
        "not known here.\n"
        "- On the air a packet and its CRC-16/XMODEM stand in PPP-COBS and 00, in pieces of 39 bytes behind "
        "three of header (`protocols/ppp_cobs.h`). The host never sees it.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = 32,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives =
        drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_WHEEL_SPEED) | drives(OMNIHIL_MODE_COAST),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_tigers_base_station() { return kFormat; }

}  // namespace omnihil
