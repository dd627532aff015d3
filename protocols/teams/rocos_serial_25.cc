// rocos (Chinese SSL teams): 25-byte packets on a serial transmitter, up to three robots in each.
//
//   start    FF B0 01 02 03 · 00 … · CRC, then FF B0 04 05 06 · channel · 00 … · CRC, each answered by 25 bytes
//   drive    FF · robots 15-8, 7-0 as bits · three times six bytes, robots ascending · channel and 7 · 00 00 00
//   answer   FF 02 · robot · flags · 00 …
//
// Source: Robocup-ssl-China/rocos b68996a (Client/src/actionmodule.cpp; layout only).
#include <algorithm>
#include <array>
#include <cmath>

#include "firmware_iface/checksum.h"
#include "protocols/codec.h"
#include "protocols/dongles/plain_dongle.h"
#include "protocols/field_rows.h"
#include "protocols/plain_packet.h"
#include "protocols/scale_rules.h"

namespace omnihil {
namespace {

constexpr int kBytes = 25;
constexpr std::size_t kSlots = 3;
constexpr double kCountsPerRad_s = 40.0;

constexpr ChecksumRule kCrc{.kind = &kCrc8Maxim, .until = -1};

constexpr Field zeros(std::string_view name, int bits) {
  return enveloped(reserved(name, bits, "sent as 0"));
}
constexpr Field speed(std::string_view name, std::string_view unit, std::string_view what) {
  return scaled(name, 10, Sign::kMagnitude, kWhole, -511, 511, unit, what);
}
constexpr std::array kSync{enveloped(constant("sync", 8, 0xFF, "begins each packet"))};

// Names of the rows of one of the three robots.
struct SlotNames {
  std::string_view high, chip, dribble, present, gap, vx, vy, vr, low, power;
};
constexpr auto slot(const SlotNames& names) {
  return std::array{
      zeros(names.high, 1),
      flag(names.chip, "the kick is a chip"),
      scaled(names.dribble, 2, Sign::kNone, kThirds, 0.0, 1.0, "", "dribbler, in thirds"),
      number(names.present, 4, "", "1 where there is a robot, else 0", 0, 1),
      zeros(names.gap, 2),
      speed(names.vx, "cm/s", "velocity forward"),
      speed(names.vy, "cm/s", "velocity to the right"),
      speed(names.vr, "1/40 rad/s", "yaw rate, clockwise seen from above"),
      zeros(names.low, 1),
      scaled(names.power, 7, Sign::kNone, kWhole, 0, 127, "", "strength of the kick; 0: none"),
  };
}
constexpr std::array<SlotNames, kSlots> kNames{{
    {"robot[0].high", "robot[0].chip", "robot[0].dribble", "robot[0].present", "robot[0].gap", "robot[0].vx",
     "robot[0].vy", "robot[0].vr", "robot[0].low", "robot[0].power"},
    {"robot[1].high", "robot[1].chip", "robot[1].dribble", "robot[1].present", "robot[1].gap", "robot[1].vx",
     "robot[1].vy", "robot[1].vr", "robot[1].low", "robot[1].power"},
    {"robot[2].high", "robot[2].chip", "robot[2].dribble", "robot[2].present", "robot[2].gap", "robot[2].vx",
     "robot[2].vy", "robot[2].vr", "robot[2].low", "robot[2].power"},
}};

constexpr auto kDrive = in_order(
    kSync,
    std::array{
        with_role(FieldRole::kRobotBits, number("robots_15_to_8", 8, "", "bit 7 robot 15 to bit 0 robot 8")),
        with_role(FieldRole::kRobotBits, number("robots_7_to_0", 8, "", "bit 7 robot 7 to bit 0 robot 0"))},
    slot(kNames[0]), slot(kNames[1]), slot(kNames[2]),
    std::array{number("frequency", 4, "", "radio channel"),
               enveloped(type_code_bits("kind", 4, 0, "7: a packet to robots")), zeros("rest", 24)});

constexpr std::array kStartHead{
    enveloped(constant("start", 8, 0xB0, "a packet for the transmitter")),
    enveloped(type_code_bits("step", 24, 4, "01 02 03, then 04 05 06")),
};
constexpr std::array kStartTail{
    zeros("rest[0]", 64),
    zeros("rest[1]", 56),
    enveloped(constant("kind_high", 4, 0, "0")),
    enveloped(type_code_bits("kind", 4, 0, "0: not a packet to robots")),
    zeros("rest[2]", 16),
    enveloped(checksum("crc", 8, "of all before it", &kCrc)),
};
constexpr auto kStart1 = in_order(kSync, kStartHead, std::array{zeros("channel", 8)}, kStartTail);
constexpr auto kStart2 = in_order(
    kSync, kStartHead,
    std::array{enveloped(constant("channel_high", 4, 1, "1")), number("frequency", 4, "", "radio channel")},
    kStartTail);

constexpr auto kAnswer =
    in_order(kSync, std::array{
                        enveloped(type_code_bits("answer", 8, 28, "2: from a robot")),
                        number("number", 8, "", "the robot where byte 23 is 0, else the robot + 1"),
                        zeros("flag_7", 1),
                        flag("ball", "it has the ball"),
                        flag("kicked_flat", "it has kicked"),
                        flag("kicked_chip", "it has chipped"),
                        zeros("flags_3_to_0", 4),
                        zeros("rest[0]", 64),
                        zeros("rest[1]", 64),
                        zeros("rest[2]", 8),
                        enveloped(constant("kind_high", 4, 0, "0")),
                        enveloped(type_code_bits("kind", 4, 0, "0: not a packet to robots")),
                        zeros("rest[3]", 8),
                        number("counts_from_1", 8, "", "0: numbers begin at 0; else at 1"),
                        zeros("rest[4]", 8),
                    });

enum Type : std::uint32_t {
  kToRobots = 0x7,
  kFirst = 0x010203u << 4,
  kSecond = 0x040506u << 4,
  kFromRobot = 0x02u << 28,
};
constexpr Message row(std::string_view name, Type type, Direction direction, std::span<const Field> fields,
                      std::string_view what, MessageRole role = MessageRole::kNone) {
  return {name, type, kBytes, false, direction, BitOrder::kMsbFirst, fields, what, role};
}
constexpr std::array kMessages{
    row("packets", kToRobots, Direction::kToRobot, kDrive,
        "Velocity, kick and dribbler of up to three robots.", MessageRole::kCommand),
    // Before the starts: an answer whose bytes 2 to 4 happen to be a step's is one all the same.
    row("answer", kFromRobot, Direction::kFromRobot, kAnswer, "A robot's answer.", MessageRole::kFeedback),
    row("start1", kFirst, Direction::kToDongle, kStart1, "Wakes the transmitter."),
    row("start2", kSecond, Direction::kToDongle, kStart2, "Sets its channel."),
};
static_assert(all_tiled(kMessages));

// The robots named by the two bytes, ascending: at most three have a place.
std::size_t robots(const Values& values, std::span<int, 16> ids) {
  const auto bits = static_cast<unsigned>(values.number("robots_7_to_0")) |
                    static_cast<unsigned>(values.number("robots_15_to_8")) << 8;
  std::size_t count = 0;
  for (int id = 0; id < 16 && count < kSlots; ++id) {
    if ((bits >> id & 1u) != 0) ids[count++] = id;
  }
  return count;
}

// The strength has no unit: 127 is the fastest ball that the league allows.
constexpr double kKickStep_m_s = 6.5 / 127.0;

RobotCommand to_command(const Values& values, int id) {
  std::array<int, 16> ids{};
  const std::size_t count = robots(values, ids);
  const auto place =
      std::find(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count), id) - ids.begin();
  const SlotNames& names = kNames[std::min(static_cast<std::size_t>(place), kSlots - 1)];
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = values.number(names.vx) / 100.0;
  command.v_left_m_s = -values.number(names.vy) / 100.0;
  command.omega_body_rad_s = -values.number(names.vr) / kCountsPerRad_s;
  command.dribbler_ratio = values.number(names.dribble);
  const double power = values.number(names.power);
  if (power > 0.0) {
    command.kick = values.flag(names.chip) ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = kKickStep_m_s * power;
  }
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  if (wanted.mode != OMNIHIL_MODE_BODY_VELOCITY || wanted.flags != 0) return false;
  if (to.robot_id < 0 || to.robot_id > 15) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when != OMNIHIL_KICK_ON_BALL || wanted.kick_pulse_s > 0.0)) return false;
  const double vx = std::round(100.0 * wanted.v_forward_m_s);
  const double vy = std::round(-100.0 * wanted.v_left_m_s);
  const double vr = std::round(-kCountsPerRad_s * wanted.omega_body_rad_s);
  const double power = kicks ? std::round(wanted.v_kick_m_s / kKickStep_m_s) : 0.0;
  // Beyond its ends the host's own encoder would say less than is asked for.
  const double largest = std::max({std::abs(vx), std::abs(vy), std::abs(vr)});
  if (!(largest <= 511.0) || !(power <= 127.0) || (kicks && power < 1.0)) return false;
  if (!(wanted.dribbler_ratio >= 0.0) || !(wanted.dribbler_ratio <= 1.0)) return false;
  Values values;
  values.message = message_of_type(kMessages, kToRobots);
  values.set("robots_15_to_8", to.robot_id >= 8 ? 1 << (to.robot_id - 8) : 0);
  values.set("robots_7_to_0", to.robot_id < 8 ? 1 << to.robot_id : 0);
  values.set("robot[0].present", 1);
  values.set("robot[0].vx", vx);
  values.set("robot[0].vy", vy);
  values.set("robot[0].vr", vr);
  values.set("robot[0].dribble", wanted.dribbler_ratio);
  values.set("robot[0].chip", wanted.kick == OMNIHIL_KICK_CHIP ? 1.0 : 0.0);
  values.set("robot[0].power", power);
  return encode_packet(values, out).error == PacketError::kNone;
}

bool answer(const Values&, int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kFromRobot);
  out.set("number", id);
  out.set("ball", (feedback.flags & OMNIHIL_FEEDBACK_BALL_SEEN) != 0 ? 1.0 : 0.0);
  return true;
}

constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      return front[0] == 0xFF ? kBytes : 0;
    },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 500'000,
    .to_host_ns = 500'000,
    .to_command = to_command,
    .robots = robots,
    .answer_gap_ns = 3'000'000,
    // The host waits for any 25 bytes.
    .dongle_answer =
        [](const Values& start, Values& out) {
          out = start;
          return true;
        },
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "rocos-serial-25",
    .title = "rocos, 25-byte serial packets",
    .source = "https://github.com/Robocup-ssl-China/rocos at b68996a",
    .notes =
        "- The host writes start1, waits for 25 bytes, writes start2, then one packet for up to three "
        "robots, at "
        "least 4 ms after the one before. Only the two start packets have a CRC.\n"
        "- Which robots: bits in bytes 1 and 2. Their six bytes follow in the order of ascending ids; a host "
        "that "
        "writes them in another order moves the wrong robots.\n"
        "- Speeds are sign and magnitude; the host cuts fractions off and holds them to 511. y is to the "
        "right and "
        "the yaw rate clockwise.\n"
        "- The host empties its buffer after 25 bytes and does not find back into step: answers come at "
        "least 3 ms "
        "apart (25 bytes take 2.2 ms). 20h and 10h in the answer (kicked) stay 0 here.\n"
        "- What the transmitter answers to a start packet is not in the sources: here the packet itself.\n"
        "- The older form over UDP, with battery and wheel speeds in the answer, is `rocos-udp`.\n",
    .carrier = {.kind = Carrier::Kind::kUart, .baud = 115'200},
    .max_frame_bytes = kBytes,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_rocos_serial_25() { return kFormat; }

}  // namespace omnihil
