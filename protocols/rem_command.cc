#include "protocols/rem_command.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocols/plain_packet.h"

namespace omnihil::rem {
namespace {

// Fields whose number is the command's own, under the names of all versions; no packet has two for one.
struct NumberRow {
  std::string_view field;
  double& (*of)(RobotCommand& command);
};
#define ROW(field, member)                                     \
  NumberRow {                                                  \
    field, [](RobotCommand& c) -> double& { return c.member; } \
  }
constexpr NumberRow kNumbers[] = {
    ROW("angularVelocity", omega_body_rad_s),
    ROW("yaw", yaw_target_rad),
    ROW("angle", yaw_target_rad),
    ROW("cameraYaw", camera_yaw_rad),
    ROW("cameraAngle", camera_yaw_rad),
    ROW("acceleration_magnitude", a_feedforward_m_s2),
    ROW("acceleration_angle", a_feedforward_angle_rad),
    ROW("wheelSpeedRef1", omega_wheel_rad_s[0]),
    ROW("wheelSpeedRef2", omega_wheel_rad_s[1]),
    ROW("wheelSpeedRef3", omega_wheel_rad_s[2]),
    ROW("wheelSpeedRef4", omega_wheel_rad_s[3]),
    ROW("wheelPWM1", duty_ratio[0]),
    ROW("wheelPWM2", duty_ratio[1]),
    ROW("wheelPWM3", duty_ratio[2]),
    ROW("wheelPWM4", duty_ratio[3]),
};
#undef ROW

struct BitRow {
  std::string_view field;
  std::uint32_t meaning;
};
constexpr BitRow kFlags[] = {
    {"useYaw", OMNIHIL_COMMAND_YAW_TARGET},           {"useAbsoluteYaw", OMNIHIL_COMMAND_YAW_TARGET},
    {"useAbsoluteAngle", OMNIHIL_COMMAND_YAW_TARGET}, {"useCameraYaw", OMNIHIL_COMMAND_CAMERA_YAW},
    {"useCameraAngle", OMNIHIL_COMMAND_CAMERA_YAW},   {"reboot", OMNIHIL_COMMAND_REBOOT},
};
// The robot looks at them from the last to the first; none of them: body velocity.
constexpr BitRow kModes[] = {
    {"useWheelSpeedRef", OMNIHIL_MODE_WHEEL_SPEED},
    {"useWheelPWMRef", OMNIHIL_MODE_WHEEL_DUTY},
    {"wheelsOff", OMNIHIL_MODE_COAST},
};

// The versions differ in which fields they have; one that is not there reads as 0 and is not written.
bool is_set(const Values& values, std::string_view field) { return values.number_or(field, 0.0) != 0.0; }
void put(Values& out, std::string_view field, double number) {
  const int index = out.message->field_index(field);
  if (index >= 0) out.fields[static_cast<std::size_t>(index)] = {.number = number, .raw = 0};
}

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

void read_kick(const Values& values, RobotCommand& command) {
  const bool chip = is_set(values, "doChip");
  const bool kick = is_set(values, "doKick");
  const bool at_yaw = is_set(values, "kickAtYaw") || is_set(values, "kickAtAngle");
  // The robot looks at chip, kick, kick-at-yaw in this order and does the first one that is set.
  if (chip) command.kick = OMNIHIL_KICK_CHIP;
  if (!chip && (kick || at_yaw)) command.kick = OMNIHIL_KICK_STRAIGHT;
  if (is_set(values, "doForce")) command.kick_when = OMNIHIL_KICK_NOW;
  if (!chip && !kick && at_yaw) command.kick_when = OMNIHIL_KICK_AT_YAW;
  if (command.kick != OMNIHIL_KICK_NONE) command.v_kick_m_s = values.number_or("kickChipPower", 0.0);
}

void put_kick(const RobotCommand& command, Values& out) {
  const bool at_yaw = command.kick_when == OMNIHIL_KICK_AT_YAW;
  const bool straight = command.kick == OMNIHIL_KICK_STRAIGHT;
  put(out, "doChip", command.kick == OMNIHIL_KICK_CHIP ? 1.0 : 0.0);
  put(out, "doKick", straight && !at_yaw ? 1.0 : 0.0);
  put(out, "kickAtYaw", straight && at_yaw ? 1.0 : 0.0);
  put(out, "kickAtAngle", straight && at_yaw ? 1.0 : 0.0);
  put(out, "doForce", command.kick_when == OMNIHIL_KICK_NOW ? 1.0 : 0.0);
  put(out, "kickChipPower", command.v_kick_m_s);
}

// What matters of a command: angles within a turn, and of the drives the one that is asked for.
RobotCommand essence(RobotCommand command) {
  command.yaw_target_rad = wrapped(command.yaw_target_rad);
  command.camera_yaw_rad = wrapped(command.camera_yaw_rad);
  command.a_feedforward_angle_rad = wrapped(command.a_feedforward_angle_rad);
  if (command.mode != OMNIHIL_MODE_BODY_VELOCITY) {
    command.v_forward_m_s = command.v_left_m_s = command.omega_body_rad_s = 0.0;
  }
  if (command.mode != OMNIHIL_MODE_WHEEL_SPEED) std::fill_n(command.omega_wheel_rad_s, OMNIHIL_WHEELS, 0.0);
  if (command.mode != OMNIHIL_MODE_WHEEL_DUTY) std::fill_n(command.duty_ratio, OMNIHIL_WHEELS, 0.0);
  // Without a velocity no frame is meant.
  if (command.v_forward_m_s == 0.0 && command.v_left_m_s == 0.0) {
    command.flags &= ~std::uint32_t{OMNIHIL_COMMAND_FIELD_FRAME};
  }
  return command;
}

void put_command(RobotCommand command, Values& out) {
  put(out, "rho", std::hypot(command.v_forward_m_s, command.v_left_m_s));
  put(out, "theta", std::atan2(command.v_left_m_s, command.v_forward_m_s));
  for (const NumberRow& row : kNumbers) put(out, row.field, row.of(command));
  for (const BitRow& row : kFlags) put(out, row.field, (command.flags & row.meaning) != 0 ? 1.0 : 0.0);
  for (const BitRow& row : kModes) put(out, row.field, command.mode == row.meaning ? 1.0 : 0.0);
  put_kick(command, out);
  put(out, "dribblerOn", command.dribbler_ratio == 1.0 ? 1.0 : 0.0);
  put(out, "dribbler", command.dribbler_ratio);
}

// Equal but for the rounding of polar coordinates.
bool same(RobotCommand a, RobotCommand b) {
  constexpr double kRounding_m_s = 1e-9;  // some 1e6 times that of a double at 30 m/s
  const auto near = [](double x, double y) { return std::abs(x - y) <= kRounding_m_s; };
  bool equal = a.mode == b.mode && a.flags == b.flags && a.kick == b.kick && a.kick_when == b.kick_when &&
               near(a.v_forward_m_s, b.v_forward_m_s) && near(a.v_left_m_s, b.v_left_m_s) &&
               a.v_kick_m_s == b.v_kick_m_s && a.kick_pulse_s == b.kick_pulse_s &&
               a.dribbler_ratio == b.dribbler_ratio;
  for (const NumberRow& row : kNumbers) equal = equal && row.of(a) == row.of(b);
  return equal;
}

// A packet can say a command if the robot would read just this out of its fields.
bool encode_as(const Message& message, const RobotCommand& command, const CommandTo& to,
               std::vector<std::uint8_t>& out) {
  Values values;
  values.message = &message;
  put_command(command, values);
  if (!same(essence(to_command(values)), command)) return false;
  values.set("toRobotId", to.robot_id);
  values.set("toColor", to.team == Team::kBlue ? 1.0 : 0.0);
  values.set("fromPC", 1.0);
  if (to.tell_all) put(values, "sendStateInfo", 1.0);
  return encode_packet(values, out).error == PacketError::kNone;
}

}  // namespace

RobotCommand to_command(const Values& values) {
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  for (const BitRow& row : kModes) {
    if (is_set(values, row.field)) command.mode = row.meaning;
  }
  command.flags = OMNIHIL_COMMAND_FIELD_FRAME;
  for (const BitRow& row : kFlags) {
    if (is_set(values, row.field)) command.flags |= row.meaning;
  }
  for (const NumberRow& row : kNumbers) {
    if (values.message->field_index(row.field) >= 0) row.of(command) = values.number(row.field);
  }
  // v = rho (cos theta, sin theta), in the field frame
  const double rho_m_s = values.number_or("rho", 0.0), theta_rad = values.number_or("theta", 0.0);
  command.v_forward_m_s = rho_m_s * std::cos(theta_rad);
  command.v_left_m_s = rho_m_s * std::sin(theta_rad);
  read_kick(values, command);
  command.dribbler_ratio = is_set(values, "dribblerOn") ? 1.0 : values.number_or("dribbler", 0.0);
  return command;
}

bool encode_command(std::span<const Message> messages, const RobotCommand& command, const CommandTo& to,
                    std::vector<std::uint8_t>& out) {
  const RobotCommand wanted = essence(command);
  for (const MessageRole role : {MessageRole::kCommand, MessageRole::kSingleCommand}) {
    const Message* message = message_of_role(messages, role);
    if (message != nullptr && encode_as(*message, wanted, to, out)) return true;
  }
  return false;
}

}  // namespace omnihil::rem
