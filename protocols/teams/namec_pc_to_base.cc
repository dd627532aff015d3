// NAMeC: protobuf between the host and the base station's serial port, several robots in a frame.
//
//   to the base    length · PCToBase: BaseCommand of each robot
//   from the base  length · BaseToPC: BaseFeedback of each robot that has answered; 00: of none
//
// Source: NAMeC-team/CRAbE 59e93be (protobuf/robot/*.proto), 06ef5bc (usb_transceiver.rs);
// NAMeC-team/base_station 066c04f (src/main.cpp); NAMeC-team/robot 02bd8fd (src/main.cpp).
#include <algorithm>
#include <array>
#include <cmath>

#include "protocols/dongles/plain_dongle.h"
#include "protocols/field_rows.h"
#include "protocols/packet_list.h"
#include "protocols/protobuf_list.h"

namespace omnihil {

const RadioFormat& radio_format_namec_pc_to_base();

namespace {

constexpr Field robot_id() {
  return tagged(1, with_role(FieldRole::kRobot, number("robot_id", 32, "", "the robot, 0 to 15", 0, 15)));
}
constexpr Field limited(Field field, double lo, double hi) {
  field.lo = lo;
  field.hi = hi;
  return field;
}
constexpr double kStrongestKick = 10.0;
constexpr auto kCommandRows = in_order(std::array{
    robot_id(),
    tagged(2, float32("normal_velocity", "m/s", "velocity forward")),
    tagged(3, float32("tangential_velocity", "m/s", "velocity to the left")),
    tagged(4, float32("angular_velocity", "rad/s", "yaw rate, anticlockwise seen from above")),
    tagged(5, number("kick", 8, "", "0 none, 1 flat, 2 chip", 0, 2)),
    tagged(6, limited(float32("kick_power", "", "strength of the kick; 1: full"), 0.0, kStrongestKick)),
    tagged(8, number("charge", 8, "", "1: charge the kicker", 0, 1)),
    tagged(9, float32("dribbler", "", "share of full speed")),
});
constexpr Field motor(int number, std::string_view name, std::string_view what) {
  return tagged(number + 1, float32(name, "rad/s", what));
}
constexpr auto kFeedbackRows =
    in_order(std::array{robot_id(), motor(1, "motor_1_speed", "wheel 1"),
                        motor(2, "motor_2_speed", "wheel 2"), motor(3, "motor_3_speed", "wheel 3"),
                        motor(4, "motor_4_speed", "wheel 4"), tagged(6, float32("voltage", "V", "battery")),
                        tagged(7, number("ir", 8, "", "1: the ball is in the beam", 0, 1))});

enum Type : std::uint32_t { kCommand = 1, kFeedback = 2 };
constexpr Message row(std::string_view name, Type type, Direction direction, std::span<const Field> fields,
                      std::string_view what, MessageRole role) {
  const int bytes = (fields.back().bit + fields.back().bits) / 8;
  return {name, type, bytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
}
constexpr std::array kMessages{
    row("BaseCommand", kCommand, Direction::kToRobot, kCommandRows, "What one robot is to do.",
        MessageRole::kCommand),
    row("BaseFeedback", kFeedback, Direction::kFromRobot, kFeedbackRows, "One robot's answer.",
        MessageRole::kFeedback),
};
static_assert(all_tiled(kMessages));
constexpr PacketList kList{.begin = {}, .most = 6};

constexpr double kFullKick_m_s =
    6.5;  // power has no unit in the sources: the fastest ball that the league allows

RobotCommand to_command(const Values& values, int) {
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = values.number("normal_velocity");
  command.v_left_m_s = values.number("tangential_velocity");
  command.omega_body_rad_s = values.number("angular_velocity");
  command.dribbler_ratio = std::clamp(values.number("dribbler"), 0.0, 1.0);
  if (values.flag("charge")) command.flags |= OMNIHIL_COMMAND_CHARGE;
  const double kick = values.number("kick");
  if (kick != 0.0) {
    command.kick = kick == 2.0 ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
    command.kick_when = OMNIHIL_KICK_NOW;
    command.v_kick_m_s = kFullKick_m_s * std::min(values.number("kick_power"), 1.0);
  }
  return command;
}

bool encode_command(const RobotCommand& wanted, const CommandTo& to, std::vector<std::uint8_t>& out) {
  if (wanted.mode != OMNIHIL_MODE_BODY_VELOCITY || to.robot_id < 0 || to.robot_id > 15) return false;
  if ((wanted.flags & ~std::uint32_t{OMNIHIL_COMMAND_CHARGE}) != 0) return false;
  const bool kicks = wanted.kick != OMNIHIL_KICK_NONE;
  if (kicks && (wanted.kick_when != OMNIHIL_KICK_NOW || wanted.kick_pulse_s > 0.0)) return false;
  if (kicks && !(wanted.v_kick_m_s <= kFullKick_m_s)) return false;
  if (!(wanted.dribbler_ratio >= 0.0) || !(wanted.dribbler_ratio <= 1.0)) return false;
  Values values;
  values.message = message_of_type(kMessages, kCommand);
  values.set("robot_id", to.robot_id);
  values.set("normal_velocity", wanted.v_forward_m_s);
  values.set("tangential_velocity", wanted.v_left_m_s);
  values.set("angular_velocity", wanted.omega_body_rad_s);
  values.set("dribbler", wanted.dribbler_ratio);
  values.set("charge", (wanted.flags & OMNIHIL_COMMAND_CHARGE) != 0 ? 1.0 : 0.0);
  values.set("kick", !kicks ? 0.0 : wanted.kick == OMNIHIL_KICK_CHIP ? 2.0 : 1.0);
  values.set("kick_power", kicks ? wanted.v_kick_m_s / kFullKick_m_s : 0.0);
  return encode_list(radio_format_namec_pc_to_base(), std::span(&values, 1), out).error == PacketError::kNone;
}

bool answer(const Values&, int id, const RobotFeedback& feedback, Values& out) {
  constexpr std::string_view kMotors[] = {"motor_1_speed", "motor_2_speed", "motor_3_speed", "motor_4_speed"};
  out.message = message_of_type(kMessages, kFeedback);
  out.set("robot_id", id);
  for (std::size_t w = 0; w < OMNIHIL_WHEELS; ++w) out.set(kMotors[w], feedback.omega_wheel_rad_s[w]);
  out.set("voltage", feedback.battery_V);
  out.set("ir", (feedback.flags & OMNIHIL_FEEDBACK_BALL_SEEN) != 0 ? 1.0 : 0.0);
  return true;
}

// On the air: 140 us to the robot, 130 us for the aerial to turn round, 132 us back (base station's main.cpp).
constexpr PlainDongle kDongle{
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 140'000,
    .to_command = to_command,
    .turn_ns = 402'000,
    .answer = answer,
};

constinit const RadioFormat kFormat{
    .id = "namec-pc-to-base",
    .title = "NAMeC, protobuf to the base station",
    .source =
        "https://github.com/NAMeC-team/CRAbE at 59e93be, https://github.com/NAMeC-team/base_station at "
        "066c04f",
    .notes =
        "- The length stands in one byte: no more than 255 bytes of protobuf, six robots. 00 alone is a "
        "frame without "
        "robots; the base takes no notice of it.\n"
        "- Numbers that are 0 are left out; so the encoders of prost, nanopb and protobuf write, in the "
        "order of the "
        "fields. Fields in another order, written zeros and unknown fields are refused here.\n"
        "- Both ways have the same outer fields: nothing tells a command from an answer but what is inside. "
        "A packet that "
        "could be both is read as a command; kick_power above 10 (no kick has that) is an answer's voltage.\n"
        "- The base sends each robot's part on by itself (nRF24L01, 2 Mb/s) and writes the answers as one "
        "frame when all "
        "have come. If one is missing it waits half a second for each robot first; here it does not wait.\n"
        "- Baud rate: 115200 and 460800 in different versions of the base station.\n"
        "- The robot kicks at once, whether the ball is there or not, once for each packet. The sources give "
        "no unit of "
        "kick_power, and none of the motors' speeds: rad/s here. It stops after half a second without a "
        "packet.\n",
    .carrier = {.kind = Carrier::Kind::kUart, .baud = 115'200},
    .framing = Framing::kProtobuf,
    .max_frame_bytes = protobuf_frame_bytes(most_protobuf_bytes(kMessages[0]), kList.most),
    .messages = kMessages,
    .list = &kList,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_namec_pc_to_base() { return kFormat; }

}  // namespace omnihil
