// rocos (Chinese SSL teams), the older form by UDP: 25-byte packets to a transmitter, up to four robots in each.
//
//   start   F0 · channel twice · 01 to the transmitter, 02 to the receiver · 02 · sum
//   drive   4 and a bit per place · four times: chip, dribbler, robot · vx · vy · vr, each sign and 7 bits ·
//           four times the high bits · four strengths
//   answer  FF 02 · robot + 1 · flags · battery · capacitor · four wheels · 00 …
//
// Source: Robocup-ssl-China/rocos 5498b33 (Client/src/actionmodule.cpp, before it was commented out; layout only).
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

constexpr int kStartBytes = 6, kDriveBytes = 25, kAnswerBytes = 26;
constexpr std::size_t kPlaces = 4;
constexpr double kCountsPerRad_s = 160.0;

constexpr ChecksumRule kSum{.kind = &kSum8, .until = -1};

// Names of the rows of one of the four robots.
struct Names {
  std::string_view present, gap, chip, dribble, id;
  std::string_view vx_sign, vx_low, vy_sign, vy_low, vr_sign, vr_low;
  std::string_view vx_high, vy_high, vr_high, unused, power;
};
constexpr std::array<Names, kPlaces> kNames{{
    {"robot[0].present", "robot[0].gap", "robot[0].chip", "robot[0].dribble", "robot[0].id",
     "robot[0].vx_sign", "robot[0].vx_low", "robot[0].vy_sign", "robot[0].vy_low", "robot[0].vr_sign",
     "robot[0].vr_low", "robot[0].vx_high", "robot[0].vy_high", "robot[0].vr_high", "robot[0].unused",
     "robot[0].power"},
    {"robot[1].present", "robot[1].gap", "robot[1].chip", "robot[1].dribble", "robot[1].id",
     "robot[1].vx_sign", "robot[1].vx_low", "robot[1].vy_sign", "robot[1].vy_low", "robot[1].vr_sign",
     "robot[1].vr_low", "robot[1].vx_high", "robot[1].vy_high", "robot[1].vr_high", "robot[1].unused",
     "robot[1].power"},
    {"robot[2].present", "robot[2].gap", "robot[2].chip", "robot[2].dribble", "robot[2].id",
     "robot[2].vx_sign", "robot[2].vx_low", "robot[2].vy_sign", "robot[2].vy_low", "robot[2].vr_sign",
     "robot[2].vr_low", "robot[2].vx_high", "robot[2].vy_high", "robot[2].vr_high", "robot[2].unused",
     "robot[2].power"},
    {"robot[3].present", "robot[3].gap", "robot[3].chip", "robot[3].dribble", "robot[3].id",
     "robot[3].vx_sign", "robot[3].vx_low", "robot[3].vy_sign", "robot[3].vy_low", "robot[3].vr_sign",
     "robot[3].vr_low", "robot[3].vx_high", "robot[3].vy_high", "robot[3].vr_high", "robot[3].unused",
     "robot[3].power"},
}};

constexpr Field zeros(std::string_view name, int bits) {
  return enveloped(reserved(name, bits, "sent as 0"));
}
constexpr auto place(const Names& names) {
  return std::array{
      zeros(names.gap, 1),
      flag(names.chip, "the kick is a chip"),
      scaled(names.dribble, 2, Sign::kNone, kThirds, 0.0, 1.0, "", "dribbler, in thirds"),
      number(names.id, 4, "", "the robot"),
      flag(names.vx_sign, "the velocity is backward"),
      number(names.vx_low, 7, "cm/s", "velocity forward, its low bits"),
      flag(names.vy_sign, "the velocity is to the right"),
      number(names.vy_low, 7, "cm/s", "velocity to the left, its low bits"),
      flag(names.vr_sign, "the yaw rate is clockwise"),
      number(names.vr_low, 7, "1/160 rad/s", "yaw rate, anticlockwise seen from above, its low bits"),
  };
}
constexpr auto high(const Names& names) {
  return std::array{number(names.vx_high, 2, "128 cm/s", "high bits of vx"),
                    number(names.vy_high, 2, "128 cm/s", "high bits of vy"),
                    number(names.vr_high, 4, "128/160 rad/s", "high bits of vr")};
}
constexpr auto power(const Names& names) {
  return std::array{zeros(names.unused, 1), number(names.power, 7, "", "strength of the kick; 0: none")};
}

enum Type : std::uint32_t {
  kDrive = 0x4,
  kToTransmitter = 0xF001,
  kToReceiver = 0xF002,
  kFromRobot = 0xFF02
};

constexpr auto kDriveRows = in_order(
    std::array{enveloped(type_code_bits("kind", 4, 0, "4: a packet to robots")),
               flag(kNames[0].present, "the first place has a robot"),
               flag(kNames[1].present, "the second place has a robot"),
               flag(kNames[2].present, "the third place has a robot"),
               flag(kNames[3].present, "the fourth place has a robot")},
    place(kNames[0]), place(kNames[1]), place(kNames[2]), place(kNames[3]), high(kNames[0]), high(kNames[1]),
    high(kNames[2]), high(kNames[3]), power(kNames[0]), power(kNames[1]), power(kNames[2]), power(kNames[3]));

constexpr auto kStartRows = in_order(std::array{
    enveloped(type_code_bits("start", 8, 8, "F0")),
    number("channel", 8, "", "4 n of radio channel n below 8, else 4 n + 58"),
    number("channel_again", 8, "", "the same"),
    enveloped(type_code_bits("whom", 8, 0, "1: the transmitter, 2: the receiver")),
    enveloped(constant("mode", 8, 2, "2")),
    enveloped(checksum("sum", 8, "of all before it", &kSum)),
});

constexpr Field wheel(std::string_view name, std::string_view what) {
  return signed_number(name, 16, "", what);
}
constexpr auto kAnswerRows = in_order(std::array{
    enveloped(type_code_bits("sync", 8, 8, "FF")),
    enveloped(type_code_bits("answer", 8, 0, "2: from a robot")),
    number("number", 8, "", "the robot + 1", 1, 16),
    zeros("flag_7", 1),
    flag("infrared", "it has the ball"),
    flag("flat", "it has kicked"),
    flag("chip", "it has chipped"),
    zeros("flags_3_to_0", 4),
    number("battery", 8, "", "196 is empty, 224 is full"),
    number("capacitance", 8, "", "29 is empty, 254 is full"),
    wheel("wheelVel[0]", "a wheel; no unit is known"),
    wheel("wheelVel[1]", "a wheel, with the other sign"),
    wheel("wheelVel[2]", "a wheel, with the other sign"),
    wheel("wheelVel[3]", "a wheel"),
    zeros("rest[0]", 64),
    zeros("rest[1]", 32),
});

constexpr Message row(std::string_view name, Type type, Direction direction, std::span<const Field> fields,
                      std::string_view what, MessageRole role = MessageRole::kNone) {
  const int bytes = (fields.back().bit + fields.back().bits) / 8;
  return {name, type, bytes, false, direction, BitOrder::kMsbFirst, fields, what, role};
}
constexpr std::array kMessages{
    row("packets", kDrive, Direction::kToRobot, kDriveRows,
        "Velocity, kick and dribbler of up to four robots.", MessageRole::kCommand),
    row("answer", kFromRobot, Direction::kFromRobot, kAnswerRows, "A robot's answer.",
        MessageRole::kFeedback),
    row("start_transmitter", kToTransmitter, Direction::kToDongle, kStartRows, "Sets its channel."),
    row("start_receiver", kToReceiver, Direction::kToDongle, kStartRows, "Sets its channel."),
};
static_assert(all_tiled(kMessages) && kMessages[0].size_bytes == kDriveBytes &&
              kMessages[1].size_bytes == kAnswerBytes && kMessages[2].size_bytes == kStartBytes);

// The robots that have a place, in the order of the places.
std::size_t robots(const Values& values, std::span<int, 16> ids) {
  std::size_t count = 0;
  for (const Names& names : kNames) {
    if (values.flag(names.present)) ids[count++] = static_cast<int>(values.number(names.id));
  }
  return count;
}

double joined(const Values& values, std::string_view sign, std::string_view low, std::string_view high) {
  const double size = values.number(low) + 128.0 * values.number(high);
  return values.flag(sign) ? -size : size;
}

// Of a robot that has two places the last one counts.
const Names* place_of(const Values& values, int id) {
  const Names* found = nullptr;
  for (const Names& names : kNames) {
    if (values.flag(names.present) && values.number(names.id) == id) found = &names;
  }
  return found;
}

// The strength has no unit: 127 is the fastest ball that the league allows.
constexpr double kKickStep_m_s = 6.5 / 127.0;

RobotCommand to_command(const Values& values, int id) {
  RobotCommand command{};
  const Names* at = place_of(values, id);
  if (at == nullptr) return command;
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = joined(values, at->vx_sign, at->vx_low, at->vx_high) / 100.0;
  command.v_left_m_s = joined(values, at->vy_sign, at->vy_low, at->vy_high) / 100.0;
  command.omega_body_rad_s = joined(values, at->vr_sign, at->vr_low, at->vr_high) / kCountsPerRad_s;
  command.dribbler_ratio = values.number(at->dribble);
  const double strength = values.number(at->power);
  if (strength > 0.0) {
    command.kick = values.flag(at->chip) ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = kKickStep_m_s * strength;
  }
  return command;
}

void split(Values& values, double count, std::string_view sign, std::string_view low, std::string_view high) {
  const double size = std::abs(count), top = std::floor(size / 128.0);
  values.set(sign, count < 0.0 ? 1.0 : 0.0);
  values.set(low, size - 128.0 * top);
  values.set(high, top);
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  if (wanted.mode != OMNIHIL_MODE_BODY_VELOCITY || wanted.flags != 0) return false;
  if (to.robot_id < 0 || to.robot_id > 15) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when != OMNIHIL_KICK_ON_BALL || wanted.kick_pulse_s > 0.0)) return false;
  const double vx = std::round(100.0 * wanted.v_forward_m_s), vy = std::round(100.0 * wanted.v_left_m_s);
  const double vr = std::round(kCountsPerRad_s * wanted.omega_body_rad_s);
  const double strength = kicks ? std::round(wanted.v_kick_m_s / kKickStep_m_s) : 0.0;
  if (!(std::abs(vx) <= 511.0) || !(std::abs(vy) <= 511.0) || !(std::abs(vr) <= 2047.0)) return false;
  if (!(strength <= 127.0) || (kicks && strength < 1.0)) return false;
  if (!(wanted.dribbler_ratio >= 0.0) || !(wanted.dribbler_ratio <= 1.0)) return false;
  Values values;
  values.message = message_of_type(kMessages, kDrive);
  const Names& at = kNames[0];
  values.set(at.present, 1.0);
  values.set(at.id, to.robot_id);
  split(values, vx, at.vx_sign, at.vx_low, at.vx_high);
  split(values, vy, at.vy_sign, at.vy_low, at.vy_high);
  split(values, vr, at.vr_sign, at.vr_low, at.vr_high);
  values.set(at.dribble, wanted.dribbler_ratio);
  values.set(at.chip, wanted.kick == OMNIHIL_KICK_CHIP ? 1.0 : 0.0);
  values.set(at.power, strength);
  return encode_packet(values, out).error == PacketError::kNone;
}

// Counts per volt, guesses: 224 counts are the 16.8 V that the same host calls full on its robots by Wi-Fi; of the
// capacitor a count is taken for a volt.
constexpr double kBatteryPerV = 224.0 / 16.8, kCapacitorPerV = 1.0;

bool answer(const Values&, int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kFromRobot);
  const auto counts = [](double x) { return std::clamp(std::round(x), 0.0, 255.0); };
  out.set("number", id + 1);
  out.set("infrared", (feedback.flags & OMNIHIL_FEEDBACK_BALL_SEEN) != 0 ? 1.0 : 0.0);
  out.set("battery", counts(kBatteryPerV * feedback.battery_V));
  out.set("capacitance", counts(kCapacitorPerV * feedback.capacitor_V));
  return true;
}

constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      if (front[0] == 0xF0) return kStartBytes;
      return front[0] >> 4 == kDrive ? kDriveBytes : 0;
    },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 500'000,
    .to_host_ns = 500'000,
    .to_command = to_command,
    .robots = robots,
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "rocos-udp",
    .title = "rocos, 25-byte packets by UDP",
    .source = "https://github.com/Robocup-ssl-China/rocos at 5498b33",
    .notes =
        "- The form before `rocos-serial-25`, to a transmitter and a receiver on the network, both at port "
        "1030. The host "
        "writes start_transmitter and start_receiver, then a packet for up to four robots, at least 3 ms "
        "after the one "
        "before. It hears answers at its own port 1030 only, from whatever port it wrote: `serve --device "
        "'udp:HOST:1030?listen=1&to=1030'`, HOST the address that it has for both.\n"
        "- Speeds are cut off towards zero, in cm/s; the yaw rate in counts of 1/160 rad/s, the same host's "
        "first version "
        "(69f4c44) wrote 40 per rad/s. A speed stands in two places: sign and seven bits, and the rest "
        "behind all "
        "robots. y is to the left and the yaw rate anticlockwise, unlike those of the serial form.\n"
        "- Only the start packets have a checksum. They are taken and nothing is answered; the host does not "
        "wait.\n"
        "- The host takes any answer of 14 bytes and more and has room for 26, which is what is written "
        "here. It reads "
        "the wheels' low bytes with a sign of their own and shows them nowhere; their unit is not known: "
        "here 0. "
        "infrared is the ball; flat and chip stay 0.\n"
        "- battery and capacitance: the host's own marks of empty and full. Volts per count are guesses: 224 "
        "is 16.8 V, "
        "and a count of the capacitor is 1 V.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = kAnswerBytes,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_rocos_udp() { return kFormat; }

}  // namespace omnihil
