// RoboCup ULaval "HERMES" v1: what StrategyAI writes to its base station and what the robots answer.
//
//   SPEED_MOVE to robot 3, 1 m/s forward:  version 01, source FE, robot 03, type 02, checksum, 3 floats
//   on the wire:  COBS of those 17 bytes, then 00
//
// Source: RoboCupULaval/RobotMCU 44cc54f (pyhermes/pyhermes/packet_definitions.py and
// Robot_stm32f4discovery/Src/robocup/hermes/), RoboCupULaval/StrategyAI ccddde1.
#include <array>

#include "firmware_iface/checksum.h"
#include "protocols/cobs.h"
#include "protocols/codec.h"
#include "protocols/dongles/hermes_dongle.h"
#include "protocols/field_rows.h"
#include "protocols/hermes_types.h"
#include "protocols/plain_packet.h"
#include "protocols/radio_format.h"

namespace omnihil {

const RadioFormat& radio_format_ulaval_hermes();

namespace {

constexpr std::uint64_t kHostAddress = 0xFE;
constexpr std::uint64_t kBaseStationAddress = 0x00;

constexpr Field kVersion = enveloped(version(constant("version", 8, 1, "protocol version")));
constexpr Field kType = enveloped(type_code("type", 8));
constexpr ChecksumRule kSumRule{.kind = &kSum8};
constexpr Field kSum =
    enveloped(checksum("checksum", 8, "sum of all other bytes before COBS, modulo 256", &kSumRule));

// Header of a packet to a robot, and of a robot's answer.
constexpr std::array kToRobot{kVersion, enveloped(constant("source", 8, kHostAddress, "address of the host")),
                              with_role(FieldRole::kRobot, number("robot", 8, "", "receiving robot")), kType,
                              kSum};
constexpr std::array kFromRobot{
    kVersion, number("robot", 8, "", "answering robot"),
    enveloped(address(constant("destination", 8, kBaseStationAddress, "address of the base station"))), kType,
    kSum};

constexpr std::array kSpeed{
    float32("vx", "m/s", "velocity along the robot's x axis"),
    float32("vy", "m/s", "velocity along the robot's y axis"),
    float32("vtheta", "rad/s", "yaw rate, anticlockwise seen from above"),
};

constexpr auto kRequest = in_order(kToRobot);
constexpr auto kPingResponse = in_order(kFromRobot);
constexpr auto kSpeedMove = in_order(kToRobot, kSpeed);
constexpr auto kSetRegister = in_order(
    kToRobot,
    std::array{number("register", 8, "", "0 control loop, 1 kick, 2 charge the kicker, 3 dribbler"),
               number("value", 8, "",
                      "control loop: 0 open, 1 closed, 2 closed and logged; kick: ms; dribbler: 0-3")});
constexpr auto kOpenLoop = in_order(kToRobot, std::array{
                                                  float32("cmd[0]", "", "duty of wheel 1, -1 to 1"),
                                                  float32("cmd[1]", "", "duty of wheel 2, -1 to 1"),
                                                  float32("cmd[2]", "", "duty of wheel 3, -1 to 1"),
                                                  float32("cmd[3]", "", "duty of wheel 4, -1 to 1"),
                                              });
constexpr auto kBattery =
    in_order(kFromRobot, std::array{number("decivolts", 8, "0.1 V", "battery voltage in tenths of a volt")});
constexpr auto kNumResponse =
    in_order(kFromRobot, std::array{number("value", 32, "", "packets received since the robot started")});
constexpr auto kSpeedMoveAdvance =
    in_order(kToRobot, kSpeed,
             std::array{number("dribbler", 7, "", "dribbler level 0-3; anything else stops it"),
                        boolean("charge", "charge the kicker's capacitor"),
                        number("kick_force", 8, "0.1 ms", "time the kicker is on; 0: no kick")});

constexpr Message row(std::string_view name, std::uint32_t type, int size_bytes, Direction direction,
                      std::span<const Field> fields, std::string_view what) {
  return {name, type, size_bytes, false, direction, BitOrder::kLsbFirst, fields, what};
}

constexpr Direction kTo = Direction::kToRobot;
constexpr Direction kFrom = Direction::kFromRobot;
constexpr std::array kMessages{
    answered_by(hermes::kPingResponse, row("PING_REQUEST", hermes::kPingRequest, 5, kTo, kRequest,
                                           "Are you there? Answered by PING_RESPONSE.")),
    row("PING_RESPONSE", hermes::kPingResponse, 5, kFrom, kPingResponse, "Yes."),
    row("SPEED_MOVE", hermes::kSpeedMove, 17, kTo, kSpeedMove, "Body velocity, closed loop."),
    row("SET_REGISTER", hermes::kSetRegister, 7, kTo, kSetRegister,
        "Switch the control loop, kick, charge, dribble."),
    row("OPEN_LOOP_COMMAND", hermes::kOpenLoopCommand, 21, kTo, kOpenLoop,
        "Duty of each motor; acts in the open loop only."),
    answered_by(hermes::kBatterieResponse, row("GET_BATTERIE", hermes::kGetBatterie, 5, kTo, kRequest,
                                               "Ask for the battery. Answered by BATTERIE_RESPONSE.")),
    row("BATTERIE_RESPONSE", hermes::kBatterieResponse, 6, kFrom, kBattery, "Battery voltage."),
    answered_by(hermes::kNumRequestResponse, row("GET_NUM_REQUEST", hermes::kGetNumRequest, 5, kTo, kRequest,
                                                 "Ask for the counter. Answered by NUM_REQUEST_RESPONSE.")),
    row("NUM_REQUEST_RESPONSE", hermes::kNumRequestResponse, 9, kFrom, kNumResponse,
        "Number of packets received."),
    row("SPEED_MOVE_ADVANCE", hermes::kSpeedMoveAdvance, 19, kTo, kSpeedMoveAdvance,
        "Body velocity with kicker and dribbler: the only packet StrategyAI sends."),
};
static_assert(all_tiled(kMessages));

constexpr std::size_t kLongest = 21;
constexpr std::size_t kLongestFrame = cobs_max_size(kLongest) + 1;

// Sum of all bytes but the checksum's own.
Values packet_to(int robot_id, hermes::Type type) {
  Values values;
  values.message = message_of_type(kMessages, type);
  values.set("robot", robot_id);
  return values;
}

// A robot ignores velocities in the open loop and duties in the closed one: the loop's register sets it up.
bool encode_command(const RobotCommand& command, const CommandTo& to, std::vector<std::uint8_t>& out) {
  const bool velocity = command.mode == OMNIHIL_MODE_BODY_VELOCITY;
  if (!velocity && command.mode != OMNIHIL_MODE_WHEEL_DUTY) return false;
  if (command.flags != 0 || command.kick != OMNIHIL_KICK_NONE || command.dribbler_ratio != 0.0) return false;
  Values loop = packet_to(to.robot_id, hermes::kSetRegister);
  loop.set("register", hermes::kLoop);
  loop.set("value", velocity ? 1.0 : 0.0);
  Values wanted = packet_to(to.robot_id, velocity ? hermes::kSpeedMove : hermes::kOpenLoopCommand);
  if (velocity) {
    wanted.set("vx", command.v_forward_m_s);
    wanted.set("vy", command.v_left_m_s);
    wanted.set("vtheta", command.omega_body_rad_s);
  } else {
    for (std::size_t w = 0; w < OMNIHIL_WHEELS; ++w)
      wanted.set(hermes::kDutyFields[w], command.duty_ratio[w]);
  }
  const std::size_t before = out.size();
  if (to.set_up && encode_frame(radio_format_ulaval_hermes(), loop, out).error != PacketError::kNone)
    return false;
  bool said = encode_frame(radio_format_ulaval_hermes(), wanted, out).error == PacketError::kNone;
  if (to.tell_all)
    said =
        said &&
        encode_frame(radio_format_ulaval_hermes(), packet_to(to.robot_id, hermes::kGetBatterie), out).error ==
            PacketError::kNone;
  if (said) return true;
  out.resize(before);
  return false;
}

constinit const RadioFormat kFormat{
    .id = "ulaval-hermes",
    .title = "RoboCup ULaval HERMES v1",
    .source =
        "https://github.com/RoboCupULaval/RobotMCU at 44cc54f, https://github.com/RoboCupULaval/StrategyAI "
        "at ccddde1",
    .notes =
        "- A frame is COBS(header and payload), then one byte 00. After a lost byte the receiver is in step "
        "again "
        "at the next 00: one lost byte costs one frame.\n"
        "- The checksum is the sum of all other bytes before COBS, modulo 256. It sees every change of one "
        "byte; of "
        "changes to several bytes, one in 256 passes. The robots' firmware reports a wrong checksum and acts "
        "on the "
        "packet all the same; here it is refused.\n"
        "- Floats are IEEE-754 single, little-endian; any finite number is allowed, NaN and infinity are "
        "refused.\n"
        "- The host's address is FEh. Answers go to 00h, the base station's address. 00h is also robot 0: "
        "the "
        "robots' firmware takes every packet sent to 00h as meant for itself.\n"
        "- The firmware looks up the dribbler level before it takes the charge bit away: with charge set the "
        "dribbler stops.\n"
        "- StrategyAI sends SPEED_MOVE_ADVANCE alone, one frame per robot in a burst, about 30 bursts a "
        "second.\n",
    .carrier = {.kind = Carrier::Kind::kUsbCdc},
    .framing = Framing::kCobsZero,
    .max_frame_bytes = static_cast<int>(kLongestFrame),
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_WHEEL_DUTY),
    .dongle = make_hermes_dongle,
};

}  // namespace

const RadioFormat& radio_format_ulaval_hermes() { return kFormat; }

}  // namespace omnihil
