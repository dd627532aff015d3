// RoboJackets, fleet of 2018 to 2023 (`rtp`): their host talks to each robot by Wi-Fi, with no dongle between.
//
//   to a robot    address 00 · port 2, type 0 · uid (6), message (2) · x, y, w int16 · dribbler · strength · kick bits
//   from a robot  address FE · port 2, type 0 · uid · battery · motors, ball, kicker, FPGA · 18 int16
//
// All little-endian, bits from the lowest up. Source: RoboJackets/robocup-fshare bf443b2 (rtp.hpp), robocup-software
// bd70b3d (network_radio.cpp, packet_convert.cpp), robocup-firmware d6ae6e8 (RadioLink.cpp, RadioModule.hpp).
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
constexpr std::array kHeader{
    enveloped(type_code("header.address", 8, "00 to robots, FE to the host")),
    enveloped(constant("header.port", 4, 2, "2: CONTROL")),
    enveloped(constant("header.type", 4, 0, "0: CONTROL")),
};
constexpr auto kControlRows = in_order(
    kHeader,
    std::array{with_role(FieldRole::kRobot, number("uid", 6, "", "the robot")),
               enveloped(constant("messageType", 2, 0, "0: a ControlMessage")),
               speed("bodyX", "m/s", "velocity to the right"), speed("bodyY", "m/s", "velocity forward"),
               speed("bodyW", "rad/s", "yaw rate, anticlockwise seen from above"),
               signed_number("dribbler", 8, "", "the robot reads it without sign: 0 to 128, full speed"),
               number("kickStrength", 8, "", "0 is 1 m/s (chip 0.5), 255 is 7 m/s"),
               flag("shootMode", "the kick is a chip"),
               number("triggerMode", 2, "", "0 off, 1 kick now, 2 when the ball is there"),
               number("role", 2, "", "what the robot is to the team; it lights its lamps"), padding(3)});

constexpr Field delta(std::string_view name) {
  return signed_number(name, 16, "", "encoder's change since the last packet; not written since 2019");
}
constexpr auto kStatusRows =
    in_order(kHeader, std::array{
                          with_role(FieldRole::kRobot, number("uid", 8, "", "the robot")),
                          number("battVoltage", 8, "", "counts of 0.09884 V by the host"),
                          number("motorErrors", 5, "", "a bit for each motor and the dribbler"),
                          flag("ballSenseStatus", "it has the ball"),
                          flag("kickStatus", "the kicker is charged"),
                          flag("kickHealthy", "the kicker works"),
                          flag("fpgaStatus", "1: the FPGA has an error"),
                          padding(7),
                          delta("encDeltas[0]"),
                          delta("encDeltas[1]"),
                          delta("encDeltas[2]"),
                          delta("encDeltas[3]"),
                          delta("encDeltas[4]"),
                          delta("encDeltas[5]"),
                          delta("encDeltas[6]"),
                          delta("encDeltas[7]"),
                          delta("encDeltas[8]"),
                          delta("encDeltas[9]"),
                          delta("encDeltas[10]"),
                          delta("encDeltas[11]"),
                          delta("encDeltas[12]"),
                          delta("encDeltas[13]"),
                          delta("encDeltas[14]"),
                          delta("encDeltas[15]"),
                          delta("encDeltas[16]"),
                          delta("encDeltas[17]"),
                      });

enum Type : std::uint32_t { kToRobot = 0x00, kToHost = 0xFE };
constexpr int kControlBytes = 12, kStatusBytes = 42;
constexpr std::array kMessages{
    Message{"ControlMessage", kToRobot, kControlBytes, false, Direction::kToRobot, BitOrder::kLsbFirst,
            kControlRows, "Velocity, kick and dribbler.", MessageRole::kCommand},
    Message{"RobotStatusMessage", kToHost, kStatusBytes, false, Direction::kFromRobot, BitOrder::kLsbFirst,
            kStatusRows, "A robot's state, 90 times a second, asked or not.", MessageRole::kFeedback},
};
static_assert(all_tiled(kMessages));

constexpr double kFullDribbler = 128.0;     // the robot's DribblerController.hpp
constexpr double kBatteryStep_V = 0.09884;  // rtp.hpp
constexpr double kOff = 0, kNow = 1, kOnBall = 2;

// Speeds of a kick at strengths 0 and 255: the host's global_params.cpp.
struct Kicker {
  double least_m_s, most_m_s;
  double speed(double strength) const { return least_m_s + strength / 255.0 * (most_m_s - least_m_s); }
  double strength(double v_m_s) const {
    return std::trunc(255.0 * (v_m_s - least_m_s) / (most_m_s - least_m_s));
  }
};
constexpr Kicker kFlat{1.0, 7.0}, kChip{0.5, 7.0};

RobotCommand to_command(const Values& values, int) {
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = values.number("bodyY");
  command.v_left_m_s = -values.number("bodyX");
  command.omega_body_rad_s = values.number("bodyW");
  const double dribbler = values.number("dribbler");
  command.dribbler_ratio = std::min(1.0, (dribbler < 0.0 ? dribbler + 256.0 : dribbler) / kFullDribbler);
  const double trigger = values.number("triggerMode");
  if (trigger == kNow || trigger == kOnBall) {
    const bool chip = values.flag("shootMode");
    command.kick = chip ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = trigger == kNow ? OMNIHIL_KICK_NOW : OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = (chip ? kChip : kFlat).speed(values.number("kickStrength"));
  }
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  if (wanted.mode != OMNIHIL_MODE_BODY_VELOCITY || wanted.flags != 0) return false;
  if (to.robot_id < 0 || to.robot_id > 15) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE, chip = wanted.kick == OMNIHIL_KICK_CHIP;
  if (kicks && (wanted.kick_when == OMNIHIL_KICK_AT_YAW || wanted.kick_pulse_s > 0.0)) return false;
  const double strength = kicks ? (chip ? kChip : kFlat).strength(wanted.v_kick_m_s) : 0.0;
  // Beyond its ends the host's own encoder would say less than is asked for.
  const double largest = std::max(
      {std::abs(wanted.v_forward_m_s), std::abs(wanted.v_left_m_s), std::abs(wanted.omega_body_rad_s)});
  if (!(largest <= 32.767) || !(strength >= 0.0) || !(strength <= 255.0)) return false;
  if (!(wanted.dribbler_ratio >= 0.0) || !(wanted.dribbler_ratio <= 1.0)) return false;
  const double dribbler = std::trunc(kFullDribbler * wanted.dribbler_ratio);
  Values values;
  values.message = message_of_type(kMessages, kToRobot);
  values.set("uid", to.robot_id);
  values.set("bodyX", -wanted.v_left_m_s);
  values.set("bodyY", wanted.v_forward_m_s);
  values.set("bodyW", wanted.omega_body_rad_s);
  values.set("dribbler", dribbler > 127.0 ? dribbler - 256.0 : dribbler);
  values.set("shootMode", chip ? 1.0 : 0.0);
  values.set("triggerMode", !kicks ? kOff : wanted.kick_when == OMNIHIL_KICK_NOW ? kNow : kOnBall);
  values.set("kickStrength", strength);
  return encode_packet(values, out).error == PacketError::kNone;
}

void tell(int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kToHost);
  const auto is_set = [&](std::uint32_t flag) { return (feedback.flags & flag) != 0 ? 1.0 : 0.0; };
  out.set("uid", id);
  out.set("battVoltage", std::clamp(std::floor(feedback.battery_V / kBatteryStep_V), 0.0, 255.0));
  out.set("ballSenseStatus", is_set(OMNIHIL_FEEDBACK_BALL_SEEN));
  out.set("kickStatus", is_set(OMNIHIL_FEEDBACK_CAPACITOR_CHARGED));
  out.set("kickHealthy", 1.0);
}

constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t>) -> std::optional<std::size_t> { return kControlBytes; },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 1'000'000,
    .to_host_ns = 1'000'000,
    .to_command = to_command,
    .tell_every_ns = 11'000'000,
    .tell = tell,
};

constinit const RadioFormat kFormat{
    .id = "robojackets-2023",
    .title = "RoboJackets, robots on Wi-Fi until 2023 (rtp)",
    .source =
        "https://github.com/RoboJackets/robocup-fshare at bf443b2, "
        "https://github.com/RoboJackets/robocup-software at bd70b3d, "
        "https://github.com/RoboJackets/robocup-firmware at d6ae6e8",
    .notes =
        "- No dongle: each robot is a computer on the network. It sends its state to port 25565 of the host, "
        "asked or "
        "not, every 11 ms. The host writes a command to port 25566 of the address that a robot's state came "
        "from, and "
        "to nobody that it has not heard for 250 ms; two robots at one address it takes for one. So one wire "
        "is one "
        "robot: `serve --robots 3 --device 'udp:HOST:25565?seek=1&from=25566'`, a second one by `from=` "
        "another "
        "address of this computer.\n"
        "- Velocities are in the robot's frame, x to the right and y forward, as the host's own code for the "
        "simulator "
        "turns them; they are multiplied by 1000, cut off towards zero and held to int16.\n"
        "- dribbler is a signed byte that the robot reads without sign, so full speed, 128, is -128 here.\n"
        "- Strengths 0 and 255 of a kick are the host's min_kick_speed and max_kick_speed, 1 and 7 m/s, of a "
        "chip 0.5 "
        "and 7. triggerMode 3 is read as 0.\n"
        "- The robot looks neither at the header nor at uid. Here both must be right.\n"
        "- battVoltage: the host takes counts of 0.09884 V, which is what is written here; the firmware of "
        "2023 writes "
        "a share of its range. encDeltas are what its memory held; here 0.\n"
        "- No checksum: the network has one. A robot whose last command is 250 ms old stops.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = kStatusBytes,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_robojackets_2023() { return kFormat; }

}  // namespace omnihil
