#include "protocols/meaning.h"

#include <cmath>

#include "protocols/codec.h"

namespace omnihil {
namespace {

using Command = RobotCommand;
using Feedback = RobotFeedback;

template <std::size_t w>
constexpr auto kAskWheelSpeed = [](Command& c, double x) { c.omega_wheel_rad_s[w] = x; };
template <std::size_t w>
constexpr auto kTellWheelSpeed = [](const Feedback& f) -> double { return f.omega_wheel_rad_s[w]; };
template <std::size_t w>
constexpr auto kAskDuty = [](Command& c, double x) { c.duty_ratio[w] = x; };
template <std::size_t w>
constexpr auto kTellDuty = [](const Feedback& f) -> double { return f.duty_ratio[w]; };

void kick(Command& command, double flag, std::uint32_t kind) {
  if (flag == 0.0) return;
  command.kick = kind;
  if (command.kick_when != OMNIHIL_KICK_NOW) command.kick_when = OMNIHIL_KICK_ON_BALL;
}
double is_set(const Feedback& feedback, std::uint32_t flag) {
  return (feedback.flags & flag) != 0 ? 1.0 : 0.0;
}

constexpr std::string_view kEcho = "echo";
constexpr Meaning kMeanings[] = {
    {"v_forward_m_s", "velocity forward, or x in the field frame",
     [](Command& c, double x) { c.v_forward_m_s = x; },
     [](const Feedback& f) -> double { return f.v_forward_m_s; }},
    {"v_left_m_s", "velocity to the left, or y in the field frame",
     [](Command& c, double x) { c.v_left_m_s = x; },
     [](const Feedback& f) -> double { return f.v_left_m_s; }},
    {"omega_body_rad_s", "yaw rate, anticlockwise seen from above",
     [](Command& c, double x) { c.omega_body_rad_s = x; },
     [](const Feedback& f) -> double { return f.omega_body_rad_s; }},
    {"yaw_rad", "heading wanted; of an answer, the heading",
     [](Command& c, double x) {
       c.flags |= OMNIHIL_COMMAND_YAW_TARGET;
       c.yaw_target_rad = x;
     },
     [](const Feedback& f) -> double { return std::remainder(f.yaw_rad, 2.0 * 3.14159265358979323846); }},
    {"camera_yaw_rad", "heading as vision sees it",
     [](Command& c, double x) {
       c.flags |= OMNIHIL_COMMAND_CAMERA_YAW;
       c.camera_yaw_rad = x;
     },
     nullptr},
    {"omega_wheel_rad_s[0]", "speed of wheel 0", kAskWheelSpeed<0>, kTellWheelSpeed<0>},
    {"omega_wheel_rad_s[1]", "speed of wheel 1", kAskWheelSpeed<1>, kTellWheelSpeed<1>},
    {"omega_wheel_rad_s[2]", "speed of wheel 2", kAskWheelSpeed<2>, kTellWheelSpeed<2>},
    {"omega_wheel_rad_s[3]", "speed of wheel 3", kAskWheelSpeed<3>, kTellWheelSpeed<3>},
    {"duty_ratio[0]", "duty of wheel 0, -1 to 1", kAskDuty<0>, kTellDuty<0>},
    {"duty_ratio[1]", "duty of wheel 1, -1 to 1", kAskDuty<1>, kTellDuty<1>},
    {"duty_ratio[2]", "duty of wheel 2, -1 to 1", kAskDuty<2>, kTellDuty<2>},
    {"duty_ratio[3]", "duty of wheel 3, -1 to 1", kAskDuty<3>, kTellDuty<3>},
    {"dribbler_ratio", "dribbler, 0 to 1", [](Command& c, double x) { c.dribbler_ratio = x; }, nullptr},
    {"wheels_free", "not 0: the wheels run free",
     [](Command& c, double x) {
       if (x != 0.0) c.mode = OMNIHIL_MODE_COAST;
     },
     nullptr},
    {"charge", "not 0: charge the kicker",
     [](Command& c, double x) {
       if (x != 0.0) c.flags |= OMNIHIL_COMMAND_CHARGE;
     },
     nullptr},
    {"kick_straight", "not 0: kick, when the ball is there",
     [](Command& c, double x) { kick(c, x, OMNIHIL_KICK_STRAIGHT); }, nullptr},
    {"kick_chip", "not 0: chip, when the ball is there",
     [](Command& c, double x) { kick(c, x, OMNIHIL_KICK_CHIP); }, nullptr},
    {"kick_now", "not 0: without a look at the ball",
     [](Command& c, double x) {
       if (x != 0.0) c.kick_when = OMNIHIL_KICK_NOW;
     },
     nullptr},
    {"v_kick_m_s", "speed of the ball", [](Command& c, double x) { c.v_kick_m_s = x; }, nullptr},
    {"kick_pulse_s", "time the kicker is on", [](Command& c, double x) { c.kick_pulse_s = x; }, nullptr},
    {"battery_V", "battery", nullptr, [](const Feedback& f) -> double { return f.battery_V; }},
    {"capacitor_V", "kicker's capacitor", nullptr, [](const Feedback& f) -> double { return f.capacitor_V; }},
    {"ball_seen", "1: it has the ball", nullptr,
     [](const Feedback& f) { return is_set(f, OMNIHIL_FEEDBACK_BALL_SEEN); }},
    {"charged", "1: the kicker is charged", nullptr,
     [](const Feedback& f) { return is_set(f, OMNIHIL_FEEDBACK_CAPACITOR_CHARGED); }},
    {kEcho, "the field of the same name in the packet that is answered", nullptr, nullptr},
};

}  // namespace

std::span<const Meaning> meanings() { return kMeanings; }

const Meaning* find_meaning(std::string_view word) {
  for (const Meaning& meaning : kMeanings) {
    if (meaning.word == word) return &meaning;
  }
  return nullptr;
}

RobotCommand command_by_meaning(const Values& values) {
  RobotCommand command{};
  const Message& message = *values.message;
  if (message.asks > 0) command.mode = static_cast<std::uint32_t>(message.asks);
  if (message.in_field_frame) command.flags |= OMNIHIL_COMMAND_FIELD_FRAME;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    const double number = values.fields[i].number;
    // A field that says nothing (NaN) asks for nothing.
    if (field.means == nullptr || field.means->ask == nullptr || std::isnan(number)) continue;
    field.means->ask(command, field.times * number);
  }
  return command;
}

bool answer_by_meaning(const RadioFormat& format, const Values& to_robot, int id,
                       const RobotFeedback& feedback, Values& out) {
  out.message = message_of_role(format.messages, MessageRole::kFeedback);
  if (out.message == nullptr) return false;
  for (std::size_t i = 0; i < out.message->fields.size(); ++i) {
    const Field& field = out.message->fields[i];
    double number = 0.0;
    if (field.role == FieldRole::kRobot) {
      number = id;
    } else if (field.means != nullptr && field.means->tell != nullptr) {
      number = field.means->tell(feedback) / field.times;
      // Whole numbers to the nearest; others by their field's own rule.
      if (field.kind == FieldKind::kInteger) number = std::round(number);
    } else if (field.means != nullptr && field.means->word == kEcho) {
      number = to_robot.number_or(field.name, 0.0);
    } else {
      continue;
    }
    out.fields[i] = nearest_value(field, number);
  }
  return true;
}

namespace {

// What a driving field of a host is filled with; 0: it is for something else, and says nothing.
double wanted_of(const RobotCommand& c, std::string_view word) {
  if (word == "v_forward_m_s") return c.v_forward_m_s;
  if (word == "v_left_m_s") return c.v_left_m_s;
  if (word == "omega_body_rad_s") return c.omega_body_rad_s;
  for (std::size_t w = 0; w < kWheels; ++w) {
    const std::string_view number(&"0123"[w], 1);
    if (word.starts_with("omega_wheel_rad_s[") && word.substr(18, 1) == number) return c.omega_wheel_rad_s[w];
    if (word.starts_with("duty_ratio[") && word.substr(11, 1) == number) return c.duty_ratio[w];
  }
  return 0.0;
}

}  // namespace

bool ask_by_meaning(const RadioFormat& format, const RobotCommand& command, const CommandTo& to,
                    std::vector<std::uint8_t>& out) {
  const bool in_field = (command.flags & OMNIHIL_COMMAND_FIELD_FRAME) != 0;
  for (const Message& message : format.messages) {
    if (message.role != MessageRole::kCommand || message.asks != static_cast<int>(command.mode)) continue;
    if (command.mode == OMNIHIL_MODE_BODY_VELOCITY && message.in_field_frame != in_field) continue;
    Values values;
    values.message = &message;
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
      const Field& field = message.fields[i];
      double number = 0.0;
      if (field.role == FieldRole::kRobot) number = to.robot_id;
      if (field.role == FieldRole::kTeam) number = to.team == Team::kBlue ? 1.0 : 0.0;
      if (field.means != nullptr && field.means->ask != nullptr)
        number = wanted_of(command, field.means->word) / field.times;
      if (field.kind == FieldKind::kInteger) number = std::round(number);
      values.fields[i].number = number;
    }
    if (format.encode(values, out).error == PacketError::kNone) return true;
  }
  return false;
}

bool encode_drive(const RadioFormat& format, const RobotCommand& command, const CommandTo& to,
                  std::vector<std::uint8_t>& out) {
  return format.encode_command != no_command ? format.encode_command(command, to, out)
                                             : ask_by_meaning(format, command, to, out);
}

}  // namespace omnihil
