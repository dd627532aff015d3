// A made-up format with a plain dongle: what the whole of a third format looks like. Not in the registry; the
// test beside it drives a robot through it.
//
//   to a robot    55 · robot · 01 · forward, left mm/s and turn mrad/s, uint16 + 32768 each · sum
//                 55 · robot · 02 · duty of each wheel, 0 to 255 for -1 to 1 · two spare bytes · sum
//   from a robot  55 · robot · 03 · battery in 0.1 V · five spare bytes · sum
//
// Every frame has ten bytes, little-endian; the sum is of all bytes before it, modulo 256.
#include <array>
#include <cmath>

#include "firmware_iface/checksum.h"
#include "protocols/codec.h"
#include "protocols/dongles/plain_dongle.h"
#include "protocols/field_rows.h"
#include "protocols/radio_format.h"

namespace omnihil {

const RadioFormat& radio_format_example_plain();

namespace {

constexpr int kFrameBytes = 10;
constexpr std::uint8_t kSync = 0x55;
enum Type : std::uint32_t { kMove = 1, kDuty = 2, kState = 3 };

constexpr auto kHead = std::array{
    enveloped(constant("sync", 8, kSync, "begins each frame")),
    with_role(FieldRole::kRobot, number("robot", 8, "", "0 to 15; the robot meant, or answering", 0, 15)),
    enveloped(type_code("type", 8))};
constexpr auto kSum = std::array{enveloped(checksum("sum", 8, "sum of all other bytes, modulo 256"))};
// Offset binary: raw 0 is the lowest value; ranged rows do this in float32.
constexpr Field speed(std::string_view name, std::string_view unit, std::string_view what) {
  return ranged(name, 16, -32.768, 32.767, unit, what);
}
constexpr Field duty(std::string_view name) { return ranged(name, 8, -1.0, 1.0, "", "duty of this wheel"); }

constexpr auto kMoveFields =
    in_order(kHead,
             std::array{speed("forward", "m/s", "body velocity ahead"),
                        speed("left", "m/s", "body velocity to the left"),
                        speed("turn", "rad/s", "yaw rate, anticlockwise seen from above")},
             kSum);
constexpr auto kDutyFields = in_order(
    kHead,
    std::array{duty("duty1"), duty("duty2"), duty("duty3"), duty("duty4"), reserved("spare", 16, "unused")},
    kSum);
constexpr auto kStateFields = in_order(
    kHead, std::array{number("decivolts", 8, "0.1 V", "battery"), reserved("spare", 40, "unused")}, kSum);

constexpr Message row(std::string_view name, Type type, Direction direction, std::span<const Field> fields,
                      std::string_view what, MessageRole role) {
  return {name, type, kFrameBytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
}
constexpr std::array kMessages{
    row("MOVE", kMove, Direction::kToRobot, kMoveFields, "Body velocity.", MessageRole::kCommand),
    row("DUTY", kDuty, Direction::kToRobot, kDutyFields, "Duty of each wheel.", MessageRole::kCommand),
    row("STATE", kState, Direction::kFromRobot, kStateFields, "The robot's answer.", MessageRole::kFeedback),
};
static_assert(all_tiled(kMessages));

std::uint8_t sum_of(std::span<const std::uint8_t> frame) { return sum8(frame.first(kFrameBytes - 1)); }

DecodeResult refused(PacketError error, std::string_view field) {
  DecodeResult result;
  result.error = error;
  result.field = field;
  return result;
}

DecodeResult decode(std::span<const std::uint8_t> frame) {
  if (frame.size() < kFrameBytes) return refused(PacketError::kTooShort, "");
  if (frame.size() > kFrameBytes) return refused(PacketError::kTooLong, "");
  const Message* message = message_of_type(kMessages, frame[2]);
  if (message == nullptr) return refused(PacketError::kUnknownType, "type");
  if (frame.back() != sum_of(frame)) return refused(PacketError::kChecksum, "sum");
  DecodeResult result;
  const FieldFault fault = decode_fields(*message, frame, kFrameBytes, result.values);
  result.error = fault.error;
  result.field = fault.field;
  return result;
}

RadioFormat::EncodeResult encode(const Values& values, std::vector<std::uint8_t>& out) {
  std::array<std::uint8_t, kFrameBytes> frame{};
  const FieldFault fault = encode_fields(values, frame.size(), frame);
  if (fault.error != PacketError::kNone) return {fault.error, fault.field};
  frame.back() = sum_of(frame);
  out.insert(out.end(), frame.begin(), frame.end());
  return {};
}

constexpr std::string_view kDuties[] = {"duty1", "duty2", "duty3", "duty4"};

RobotCommand to_command(const Values& values, int) {
  RobotCommand command{};
  if (values.message->type == kMove) {
    command.mode = OMNIHIL_MODE_BODY_VELOCITY;
    command.v_forward_m_s = values.number("forward");
    command.v_left_m_s = values.number("left");
    command.omega_body_rad_s = values.number("turn");
  } else {
    command.mode = OMNIHIL_MODE_WHEEL_DUTY;
    for (std::size_t w = 0; w < OMNIHIL_WHEELS; ++w) command.duty_ratio[w] = values.number(kDuties[w]);
  }
  return command;
}

bool encode_command(const RobotCommand& command, const CommandTo& to, std::vector<std::uint8_t>& out) {
  const bool velocity = command.mode == OMNIHIL_MODE_BODY_VELOCITY;
  if (!velocity && command.mode != OMNIHIL_MODE_WHEEL_DUTY) return false;
  if (command.flags != 0 || command.kick != OMNIHIL_KICK_NONE || command.dribbler_ratio != 0.0) return false;
  Values values;
  values.message = message_of_type(kMessages, velocity ? kMove : kDuty);
  values.set("robot", to.robot_id);
  if (velocity) {
    values.set("forward", command.v_forward_m_s);
    values.set("left", command.v_left_m_s);
    values.set("turn", command.omega_body_rad_s);
  } else {
    for (std::size_t w = 0; w < OMNIHIL_WHEELS; ++w) values.set(kDuties[w], command.duty_ratio[w]);
  }
  return encode(values, out).error == PacketError::kNone;
}

bool answer(const Values&, int id, const RobotFeedback& feedback, Values& out) {
  out.message = message_of_type(kMessages, kState);
  out.set("robot", id);
  out.set("decivolts", std::floor(10.0 * feedback.battery_V));
  return true;
}

constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      return front[0] == kSync ? kFrameBytes : 0;
    },
    .to_robot_ns = 300'000,
    .to_host_ns = 700'000,
    .to_command = to_command,
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "example-plain",
    .title = "Example with a plain dongle",
    .source = "made up",
    .notes = "",
    .carrier = {.kind = Carrier::Kind::kUart, .baud = 115'200},
    .max_frame_bytes = kFrameBytes,
    .messages = kMessages,
    .own_decode = decode,
    .own_encode = encode,
    .own_codec = "the sum leaves itself out",
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_WHEEL_DUTY),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_example_plain() { return kFormat; }

}  // namespace omnihil
