// Rhoban's and NAMeC's robots (AMC boards): a main board as dongle, lists of packets to robots and of their states.
//
//   to the dongle    AA 55 · n · n times 17 bytes: robot, instruction, data, 00 … · FF
//   from the dongle  AA 55 · n · n times 11 bytes: robot, its status · FF
//
// All little-endian, packed. Source: Rhoban/SSL 57743b2 (host), Rhoban/SSL-Electronics 283b766 (boards).
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "protocols/codec.h"
#include "protocols/dongles/plain_dongle.h"
#include "protocols/field_rows.h"
#include "protocols/packet_list.h"

namespace omnihil {

const RadioFormat& radio_format_rhoban_master_serial();

namespace {

constexpr int kToRobotBytes = 17, kFromRobotBytes = 11;
constexpr std::array<std::uint8_t, 2> kBegin{0xAA, 0x55};
constexpr PacketList kList{.begin = kBegin, .end = 0xFF, .most = 8};

constexpr Field zeros(std::string_view name, int bits) {
  return enveloped(reserved(name, bits, "sent as 0"));
}
constexpr std::array kHead{
    with_role(FieldRole::kRobot, number("robot", 8, "", "0 to 7; the robot meant", 0, 7)),
    enveloped(type_code("instruction", 8, "what the data are")),
};
enum Action : std::uint32_t { kOn = 1, kChip = 2, kFlat = 4, kDribble = 8, kCharge = 32, kTare = 128 };
constexpr auto kMaster = in_order(
    kHead,
    std::array{
        number("actions", 8, "",
               "bit 0 on, 1 kick 1 (chip), 2 kick 2 (flat), 3 dribble, 5 charge, 7 set the odometry"),
        signed_number("x_speed", 16, "mm/s", "velocity forward; with bit 7 x in mm"),
        signed_number("y_speed", 16, "mm/s", "velocity to the left; with bit 7 y in mm"),
        signed_number("t_speed", 16, "mrad/s", "yaw rate; with bit 7 the heading in 1/10000 rad"),
        number("kick_power", 8, "30 us", "time the kicker is on, by the firmware; both headers say 25 us"),
        zeros("rest", 56)});
constexpr auto kParams = in_order(
    kHead, std::array{float32("kp", "", "P of the wheels; the robot does not use it"),
                      float32("ki", "", "I of the wheels; the robot does not use it"),
                      float32("kd", "", "D of the wheels; the robot does not use it"), zeros("rest", 24)});
constexpr auto kMusic = in_order(
    kHead, std::array{number("instrument", 8, "", "bit 0 on, 1 beeper, 2 kicker, 3 chipper, 5 dribbler"),
                      number("note", 16, "Hz", "its pitch"), number("duration", 16, "", "how long it sounds"),
                      zeros("rest[0]", 64), zeros("rest[1]", 16)});
enum StatusBit : std::uint32_t { kOk = 1, kDriverError = 2, kBall = 4 };
constexpr auto kStatus = in_order(std::array{
    with_role(FieldRole::kRobot, number("robot", 8, "", "the robot that answered")),
    number("id", 8, "", "its own id"),
    number("status", 8, "", "bit 0 well, 1 error of a driver, 2 it has the ball"),
    number("cap_volt", 8, "V", "kicker's capacitor"),
    number("voltage_raw", 8, "0.125 V", "battery, by the firmware; the host's header says 0.1 V"),
    signed_number("xpos", 16, "mm", "odometry, x"),
    signed_number("ypos", 16, "mm", "odometry, y"),
    signed_number("ang_raw", 16, "mrad",
                  "heading, as the firmware computes it; its comment says 1/10000 rad"),
});

enum Type : std::uint32_t { kDrive = 0, kGains = 1, kSong = 2, kState = 0x100 };
constexpr Message row(std::string_view name, Type type, int size_bytes, Direction direction,
                      std::span<const Field> fields, std::string_view what,
                      MessageRole role = MessageRole::kNone) {
  return {name, type, size_bytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
}
constexpr std::array kMessages{
    row("master", kDrive, kToRobotBytes, Direction::kToRobot, kMaster, "Velocity, kicker and dribbler.",
        MessageRole::kCommand),
    row("params", kGains, kToRobotBytes, Direction::kToRobot, kParams, "Gains of the wheels."),
    row("music", kSong, kToRobotBytes, Direction::kToRobot, kMusic, "A tone."),
    row("status", kState, kFromRobotBytes, Direction::kFromRobot, kStatus,
        "A robot's answer to its packet in the list.", MessageRole::kFeedback),
};
static_assert(all_tiled(kMessages));

constexpr int kLongestFrame = 3 + 8 * kToRobotBytes + 1;
constexpr double kKickStep_s = 30e-6;

RobotCommand to_command(const Values& values, int) {
  RobotCommand command{};
  const auto actions = static_cast<std::uint32_t>(values.number("actions"));
  if ((actions & kCharge) != 0) command.flags |= OMNIHIL_COMMAND_CHARGE;
  if ((actions & kOn) == 0) return command;
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  if ((actions & kTare) == 0) {  // otherwise they are a place; nothing here keeps one
    command.v_forward_m_s = values.number("x_speed") / 1000.0;
    command.v_left_m_s = values.number("y_speed") / 1000.0;
    command.omega_body_rad_s = values.number("t_speed") / 1000.0;
  }
  if ((actions & (kChip | kFlat)) != 0) {
    command.kick = (actions & kChip) != 0 ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = OMNIHIL_KICK_ON_BALL;
    command.kick_pulse_s = kKickStep_s * values.number("kick_power");
  }
  command.dribbler_ratio = (actions & kDribble) != 0 ? 1.0 : 0.0;
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  const bool drives = wanted.mode == OMNIHIL_MODE_BODY_VELOCITY;
  if (!drives && wanted.mode != OMNIHIL_MODE_COAST) return false;
  if ((wanted.flags & ~OMNIHIL_COMMAND_CHARGE) != 0) return false;
  if (wanted.dribbler_ratio != 0.0 && wanted.dribbler_ratio != 1.0) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when != OMNIHIL_KICK_ON_BALL || wanted.v_kick_m_s > 0.0)) return false;
  std::uint32_t actions = drives ? std::uint32_t{kOn} : 0U;
  if ((wanted.flags & OMNIHIL_COMMAND_CHARGE) != 0) actions |= kCharge;
  if (wanted.dribbler_ratio == 1.0) actions |= kDribble;
  if (kicks) actions |= wanted.kick == OMNIHIL_KICK_CHIP ? kChip : kFlat;
  Values values;
  values.message = message_of_type(kMessages, kDrive);
  values.set("robot", to.robot_id);
  values.set("actions", actions);
  if (drives) {
    values.set("x_speed", std::round(1000.0 * wanted.v_forward_m_s));
    values.set("y_speed", std::round(1000.0 * wanted.v_left_m_s));
    values.set("t_speed", std::round(1000.0 * wanted.omega_body_rad_s));
  }
  if (kicks) values.set("kick_power", std::round(wanted.kick_pulse_s / kKickStep_s));
  return encode_list(radio_format_rhoban_master_serial(), std::span(&values, 1), out).error ==
         PacketError::kNone;
}

bool answer(const Values&, int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kState);
  const auto put = [&](std::string_view name, double number) {
    const auto i = static_cast<std::size_t>(out.message->field_index(name));
    out.fields[i] = nearest_value(out.message->fields[i], number);
  };
  const bool has_ball = (feedback.flags & OMNIHIL_FEEDBACK_BALL_SEEN) != 0;
  put("robot", id);
  put("id", id);
  put("status", has_ball ? kOk + kBall : kOk);
  put("cap_volt", feedback.capacitor_V);
  put("voltage_raw", 8.0 * feedback.battery_V);
  put("ang_raw", 1000.0 * std::remainder(feedback.yaw_rad, 2.0 * std::numbers::pi));
  return true;
}

// The line with which a host switches the board's shell to dongle mode, three times before its first frame.
constexpr std::string_view kHello = "master\n";

constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      const std::size_t alike = std::min(front.size(), kHello.size());
      if (std::equal(front.begin(), front.begin() + static_cast<std::ptrdiff_t>(alike), kHello.begin())) {
        return kHello.size();
      }
      if (front[0] != kBegin[0] || (front.size() > 1 && front[1] != kBegin[1])) return 0;
      if (front.size() < 3) return std::nullopt;
      return front[2] <= kList.most ? std::optional<std::size_t>(4 + std::size_t{front[2]} * kToRobotBytes)
                                    : 0;
    },
    .silent_line = kHello,
    .to_robot_ns = 500'000,
    .to_host_ns = 500'000,
    .to_command = to_command,
    .kicks_once = true,
    .turn_ns = 2'000'000,
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "rhoban-master-serial",
    .title = "Rhoban and NAMeC (AMC) master",
    .source =
        "https://github.com/Rhoban/SSL at 57743b2, https://github.com/Rhoban/SSL-Electronics at 283b766",
    .notes =
        "- A frame lists packets: AA 55, their number (0 to 8), the packets one after the other, FF. No "
        "checksum. "
        "`encode` makes a frame of one packet of a JSON object, and one of several of a JSON array; `decode` "
        "prints "
        "the packets of a list.\n"
        "- The host opens the port and writes `master` and a line feed three times, which switches the "
        "board's "
        "shell to dongle mode; frames follow. The dongle gives each robot of the list its turn of 2 ms, then "
        "answers "
        "with one frame that lists the robots that answered, perhaps none. The host sends its next frame on "
        "that "
        "answer, or after 30 ms without one.\n"
        "- Of packets as long as a list's the length of the frame tells whether they go to robots (17 bytes) "
        "or "
        "come from them (11).\n"
        "- Headers and firmware disagree on units: the battery (0.1 V; the firmware writes V times 8), the "
        "heading "
        "(1/10000 rad; mrad), the kicker's time (25 us; 30 us). Here the firmware is followed.\n"
        "- A robot kicks when a kick bit comes, not while it stays, with the ball present and the capacitor "
        "above 80 V.\n",
    .carrier = {.kind = Carrier::Kind::kUsbCdc},
    .framing = Framing::kList,
    .max_frame_bytes = kLongestFrame,
    .messages = kMessages,
    .list = &kList,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_rhoban_master_serial() { return kFormat; }

}  // namespace omnihil
