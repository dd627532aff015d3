// ER-Force's USB transceiver, protocol 5, with the radio packets of their robots Pasta and 2014.
//
//   to the dongle    command · length of the data · data;  11: address (5) · expected answer · radio packet
//   from the dongle  length of the data · command · data;  90: kind of robot · its answer
//
// All little-endian, bit-fields from the lowest bit up. Source: robotics-erlangen/framework 9814d05.
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

constexpr int kRecordBytes = 2;  // command and length, not counted in the length

constexpr Field size() { return enveloped(length("size", 8, "of the data", kRecordBytes)); }
constexpr Field command_code() { return enveloped(type_code_bits("command", 8, 0, "what the data are")); }
constexpr std::array kRecord{command_code(), size()};
constexpr std::array kReply{size(), command_code()};
constexpr Field zeros(std::string_view name, int bits) {
  return enveloped(reserved(name, bits, "sent as 0"));
}
constexpr Field of_address(std::string_view name, int bits, std::uint64_t value) {
  return enveloped(constant(name, bits, value, "address of the robots"));
}
constexpr Field last_of_address() {
  return enveloped(reserved("address[4]", 8, "the host does not set it: whatever it is is ignored"));
}
constexpr std::array kAddress{
    with_role(FieldRole::kRobot, number("address_id", 4, "", "the robot meant")),
    of_address("address[0]", 4, 4),
    of_address("address[1]", 8, 0xE8),
    of_address("address[2]", 8, 0xE4),
    of_address("address[3]", 8, 0xC7),
    last_of_address(),
    number("expected_response_size", 8, "bytes", "of the robot's answer: 11"),
};
constexpr std::array kBroadcast{
    of_address("address[0]", 8, 0x3F),
    of_address("address[1]", 8, 0),
    of_address("address[2]", 8, 0),
    of_address("address[3]", 8, 0),
    last_of_address(),
    number("expected_response_size", 8, "bytes", "1"),
};

constexpr Field milli(std::string_view name, std::string_view unit, std::string_view what) {
  return scaled(name, 16, Sign::kTwosComplement, kTruncatedOrNone, -32.767, 32.767, unit, what);
}
// One count is 2 mm/s; the header's comment says 1.
constexpr Field step_of_speed(std::string_view name, std::string_view what) {
  return scaled(name, 8, Sign::kTwosComplement, kTruncated, -0.254, 0.254, "m/s", what);
}
constexpr Field step_of_turn(std::string_view name, std::string_view what) {
  return scaled(name, 8, Sign::kTwosComplement, kTruncated, -0.635, 0.635, "rad/s", what);
}
constexpr std::array kKick{
    number("counter", 8, "", "counts packets; the robot gives it back"),
    number("shot_power", 8, "", "10/255 m/s of the ball, of a chip 5/255 m/s; 0: none"),
    flag("chip", "the kick is a chip"),
    flag("charge", "charge the kicker"),
    flag("standby", "motors off"),
    number("id", 4, "", "the robot meant, once more"),
    flag("force_kick", "kick without a look at the ball"),
    scaled("dribbler", 8, Sign::kTwosComplement, kHundredths, -1.0, 1.0, "", "share of full speed"),
};
constexpr std::array kRest{
    number("ir_param", 6, "", "threshold of the light barrier"),
    flag("eject_sdcard", "let go of the memory card"),
    zeros("flag_7", 1),
    milli("cur_v_s", "m/s", "velocity now by vision, to the right; null: unseen"),
    milli("cur_v_f", "m/s", "velocity now by vision, forward; null: unseen"),
};
constexpr std::array kSteps{
    step_of_speed("delta1[0]", "first speed of the next step less that of now"),
    step_of_speed("delta1[1]", "the same of the second speed"),
    step_of_turn("delta1[2]", "the same of the yaw rate"),
    step_of_speed("delta2[0]", "first speed of the step after it less that of the next"),
    step_of_speed("delta2[1]", "the same of the second speed"),
    step_of_turn("delta2[2]", "yaw rate of the step after it less that of now and the count of delta1[2]"),
};
constexpr Field time_offset() {
  return signed_number("time_offset", 16, "us",
                       "age of what the host knows, at most 2000, and 469 for the transfer");
}
constexpr Field omega() { return milli("omega", "rad/s", "yaw rate, anticlockwise seen from above"); }

constexpr auto kPastaRows = in_order(
    kRecord, kAddress, kKick,
    std::array{milli("v_x", "m/s", "velocity in the field frame, x"),
               milli("v_y", "m/s", "velocity in the field frame, y"), omega()},
    kRest,
    std::array{scaled("cur_phi", 16, Sign::kTwosComplement, kTruncatedAroundOrNone, -std::numbers::pi,
                      std::numbers::pi, "rad", "heading now by vision; null: unseen")},
    kSteps, std::array{zeros("sync_counter", 8), time_offset()});
constexpr auto k2014Rows =
    in_order(kRecord, kAddress, kKick,
             std::array{milli("v_s", "m/s", "velocity to the right"), milli("v_f", "m/s", "velocity forward"),
                        omega()},
             kRest, std::array{milli("cur_omega", "rad/s", "yaw rate now by vision; null: unseen")}, kSteps);
constexpr auto kSyncRows = in_order(
    kRecord, kBroadcast, std::array{number("counter", 8, "", "of the packets it goes with"), time_offset()});

constexpr std::array kTime{signed_number("time", 64, "", "whatever the host likes; given back")};
constexpr std::array kVersion{number("protocol_version", 16, "", "5")};

// The robot's answer, behind `kReply`; what bytes 2 and 3 hold says extension_id.
constexpr std::array kAnswerHead{
    number("generation", 8, "", "2 a robot of 2014, 3 Pasta"),
    number("counter", 8, "", "that of the command"),
    number("id", 4, "", "the robot"),
    flag("power_enabled", "its motors have power"),
    flag("error_present", "it reports an error"),
    flag("ball_detected", "it has the ball"),
    flag("cap_charged", "its kicker is charged"),
};
constexpr Field speed14(std::string_view name, std::string_view what) {
  return scaled(name, 14, Sign::kTwosComplement, kTruncated, -8.192, 8.191, "m/s", what);
}
constexpr std::array kAnswerRest{
    enveloped(type_code_bits("extension_id", 4, 8, "0 battery, 1 errors")),
    speed14("v_s", "velocity to the right"),
    speed14("v_f", "velocity forward"),
    scaled("omega", 16, Sign::kTwosComplement, kTruncated, -32.768, 32.767, "rad/s", "yaw rate"),
};
constexpr auto kBatteryRows = in_order(
    kReply, kAnswerHead,
    std::array{scaled("battery", 8, Sign::kNone, kTruncated, 0.0, 1.0, "", "share of a full battery"),
               scaled("packet_loss_rx", 8, Sign::kNone, kTruncated, 0.0, 255.0 / 256.0, "",
                      "share of packets that did not come")},
    kAnswerRest);
constexpr auto kErrorRows = in_order(
    kReply, kAnswerHead,
    std::array{flag("error_motor_1", "of motor 1"), flag("error_motor_2", "of motor 2"),
               flag("error_motor_3", "of motor 3"), flag("error_motor_4", "of motor 4"),
               flag("error_dribbler", "of the dribbler"), flag("error_kicker", "of the kicker"),
               flag("error_break_beam", "of the light barrier"), flag("error_encoder", "of an encoder"),
               flag("error_main_sensor", "of the gyroscope"), number("temperature", 7, "", "of the board")},
    kAnswerRest);

constexpr auto kInitRows = in_order(kRecord, kVersion);
constexpr auto kPingRows = in_order(kRecord, kTime);
constexpr auto kStatusRows = in_order(kRecord);
constexpr auto kFrequencyRows = in_order(kRecord, std::array{number("channel", 8, "", "radio channel")});
constexpr auto kInitReplyRows = in_order(kReply, kVersion);
constexpr auto kPingReplyRows = in_order(kReply, kTime);
constexpr auto kStatusReplyRows =
    in_order(kReply, std::array{number("dropped", 32, "", "packets from USB that were dropped")});

// From bit 16 on no field has them: they tell packets of one command apart, whose lengths differ.
enum Type : std::uint32_t {
  kInit = 0x00,
  kPing = 0x01,
  kStatus = 0x02,
  kFrequency = 0x10,
  kPasta = 0x10011,
  k2014 = 0x20011,
  kSync = 0x30011,
  kInitReply = 0x80,
  kPingReply = 0x81,
  kStatusReply = 0x82,
  kBattery = 0x090,
  kErrors = 0x190,
};
constexpr Message row(std::string_view name, Type type, Direction direction, std::span<const Field> fields,
                      std::string_view what, MessageRole role = MessageRole::kNone) {
  const int bytes = (fields.back().bit + fields.back().bits) / 8;
  return {name, type, bytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
}
using enum Direction;
constexpr std::array kMessages{
    row("pasta_command", kPasta, kToRobot, kPastaRows, "Velocity in the field frame, for Pasta.",
        MessageRole::kCommand),
    row("gen2014_command", k2014, kToRobot, k2014Rows, "Velocity in the robot's frame, for robots of 2014.",
        MessageRole::kCommand),
    row("gen2014_sync", kSync, Direction::kToDongle, kSyncRows, "For all robots: the time of the commands."),
    row("init", kInit, Direction::kToDongle, kInitRows, "The host's version. Answered by init_reply."),
    row("ping", kPing, Direction::kToDongle, kPingRows, "Answered by ping_reply."),
    row("status", kStatus, Direction::kToDongle, kStatusRows, "Answered by status_reply."),
    row("set_frequency", kFrequency, Direction::kToDongle, kFrequencyRows, "Radio channel."),
    row("init_reply", kInitReply, Direction::kFromDongle, kInitReplyRows,
        "The highest version that both speak."),
    row("ping_reply", kPingReply, Direction::kFromDongle, kPingReplyRows, "The same time."),
    row("status_reply", kStatusReply, Direction::kFromDongle, kStatusReplyRows, "Counts of the dongle."),
    row("response", kBattery, kFromRobot, kBatteryRows, "A robot's answer, with its battery.",
        MessageRole::kFeedback),
    row("response_errors", kErrors, kFromRobot, kErrorRows, "A robot's answer, with its errors."),
};
static_assert(all_tiled(kMessages));

constexpr double kVersionSpoken = 5.0;
constexpr double kKick_m_s = 10.0 / 255.0, kChip_m_s = 5.0 / 255.0;
constexpr double kFullBattery_V = 25.2;  // choice, as erforce-proto2025

// A speed that is no number is none.
double speed(const Values& values, std::string_view name) {
  const double given = values.number(name);
  return std::isnan(given) ? 0.0 : given;
}

RobotCommand to_command(const Values& values, int) {
  RobotCommand command{};
  if (values.flag("charge")) command.flags |= OMNIHIL_COMMAND_CHARGE;
  if (values.flag("standby")) return command;
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.omega_body_rad_s = speed(values, "omega");
  if (values.message->type == kPasta) {
    command.flags |= OMNIHIL_COMMAND_FIELD_FRAME;
    command.v_forward_m_s = speed(values, "v_x");
    command.v_left_m_s = speed(values, "v_y");
  } else {
    command.v_forward_m_s = speed(values, "v_f");
    command.v_left_m_s = -speed(values, "v_s");
  }
  const double power = values.number("shot_power");
  if (power > 0.0) {
    const bool chip = values.flag("chip");
    command.kick = chip ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = values.flag("force_kick") ? OMNIHIL_KICK_NOW : OMNIHIL_KICK_ON_BALL;
    command.v_kick_m_s = power * (chip ? kChip_m_s : kKick_m_s);
  }
  command.dribbler_ratio = std::fmax(values.number("dribbler"), 0.0);
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  const bool drives = wanted.mode == OMNIHIL_MODE_BODY_VELOCITY;
  if ((!drives && wanted.mode != OMNIHIL_MODE_COAST) || to.robot_id < 0 || to.robot_id > 15) return false;
  constexpr std::uint32_t kSaid = OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_CHARGE;
  if ((wanted.flags & ~kSaid) != 0 || !(std::abs(wanted.dribbler_ratio) <= 1.0)) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  const bool chip = wanted.kick == OMNIHIL_KICK_CHIP;
  if (kicks && (wanted.kick_when == OMNIHIL_KICK_AT_YAW || wanted.kick_pulse_s > 0.0)) return false;
  // The host cuts fractions off.
  const double power = kicks ? std::trunc(wanted.v_kick_m_s / (chip ? kChip_m_s : kKick_m_s)) : 0.0;
  // Beyond its ends the host's own encoder would say less than is asked for.
  const double largest = drives ? std::max({std::abs(wanted.v_forward_m_s), std::abs(wanted.v_left_m_s),
                                            std::abs(wanted.omega_body_rad_s)})
                                : 0.0;
  if (!(power <= 255.0) || (kicks && power < 1.0) || !(largest <= 32.767)) return false;
  const bool in_field = (wanted.flags & OMNIHIL_COMMAND_FIELD_FRAME) != 0;
  Values values;
  values.message = message_of_type(kMessages, in_field ? kPasta : k2014);
  values.set("address_id", to.robot_id);
  values.set("id", to.robot_id);
  values.set("expected_response_size", 11);
  values.set("standby", drives ? 0.0 : 1.0);
  values.set("charge", (wanted.flags & OMNIHIL_COMMAND_CHARGE) != 0 ? 1.0 : 0.0);
  values.set("shot_power", power);
  values.set("chip", chip ? 1.0 : 0.0);
  values.set("force_kick", kicks && wanted.kick_when == OMNIHIL_KICK_NOW ? 1.0 : 0.0);
  values.set("dribbler", wanted.dribbler_ratio);
  if (drives) {
    values.set(in_field ? "v_x" : "v_f", wanted.v_forward_m_s);
    values.set(in_field ? "v_y" : "v_s", in_field ? wanted.v_left_m_s : -wanted.v_left_m_s);
    values.set("omega", wanted.omega_body_rad_s);
  }
  return encode_packet(values, out).error == PacketError::kNone;
}

bool dongle_answer(const Values& asked, Values& out) {
  out = asked;
  switch (asked.message->type) {
    case kInit:
      out.message = message_of_type(kMessages, kInitReply);
      break;
    case kPing:
      out.message = message_of_type(kMessages, kPingReply);
      break;
    case kStatus:
      out.message = message_of_type(kMessages, kStatusReply);
      break;
    default:
      return false;
  }
  // Both tables have two envelope fields, then what is given back.
  for (const std::size_t envelope : {0u, 1u}) out.fields[envelope] = {};
  if (asked.message->type == kInit) {
    out.set("protocol_version", std::fmin(asked.number("protocol_version"), kVersionSpoken));
  }
  return true;
}

bool answer(const Values& to_robot, int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kBattery);
  const auto put = [&](std::string_view name, double number) {
    const auto i = static_cast<std::size_t>(out.message->field_index(name));
    out.fields[i] = nearest_value(out.message->fields[i], number);
  };
  const auto is_set = [&](std::uint32_t flag) { return (feedback.flags & flag) != 0 ? 1.0 : 0.0; };
  put("generation", to_robot.message->type == kPasta ? 3 : 2);
  put("counter", to_robot.number("counter"));
  put("id", id);
  put("power_enabled", 1.0 - to_robot.number("standby"));
  put("ball_detected", is_set(OMNIHIL_FEEDBACK_BALL_SEEN));
  put("cap_charged", is_set(OMNIHIL_FEEDBACK_CAPACITOR_CHARGED));
  put("battery", feedback.battery_V / kFullBattery_V);
  put("v_s", -feedback.v_left_m_s);
  put("v_f", feedback.v_forward_m_s);
  put("omega", feedback.omega_body_rad_s);
  return true;
}

constexpr PlainDongle kDongle{
    // A record's length is its second byte; packets for a dongle and for robots have low command numbers.
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      const bool known = std::any_of(kMessages.begin(), kMessages.end(), [&](const Message& message) {
        return (message.type & 0xFFu) == front[0] && front[0] < 0x80;
      });
      if (!known) return 0;
      if (front.size() < kRecordBytes) return std::nullopt;
      return front[1] <= 253 ? std::optional<std::size_t>(kRecordBytes + front[1]) : 0;
    },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 500'000,
    .to_host_ns = 500'000,
    .to_command = to_command,
    .dongle_answer = dongle_answer,
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "erforce-usb-pasta-2014",
    .title = "ER-Force USB transceiver, robots Pasta and 2014",
    .source = "https://github.com/robotics-erlangen/framework at 9814d05",
    .notes =
        "- The device is no serial port: the host's libusb writes several records in one bulk transfer and "
        "reads the same "
        "way (03eb:6127). Here the bytes of those transfers travel over any wire; a program with libusb is "
        "started with "
        "[a library](../usb.md) that carries them.\n"
        "- Byte 4 of the address (offset 6 of the record) is what stood in the host's memory: it is kept and "
        "ignored; "
        "so is Pasta's sync counter.\n"
        "- Numbers are cut off towards zero and held to the ends of their fields. 8000h is no number "
        "(`null`).\n"
        "- delta1 and delta2 are in steps of 2 mm/s and 5 mrad/s (the header says 1 mm/s) from one output to "
        "the "
        "next.\n"
        "- A robot answers each command with 11 bytes; every answer here has the battery, none the errors. "
        "v_s is to "
        "the right, v_f forward.\n"
        "- The dongle answers init with the lower of both versions; the host gives up one that it does not "
        "hear for "
        "0.5 to 1 s.\n"
        "- Commands 12h (data that must arrive), 91h and 92h have no fixed length and are not spoken.\n",
    .carrier = {.kind = Carrier::Kind::kUsbCdc},
    .max_frame_bytes = 34,
    .messages = kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_erforce_usb_pasta_2014() { return kFormat; }

}  // namespace omnihil
