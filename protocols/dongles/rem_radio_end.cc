#include "protocols/dongles/rem_radio_end.h"

namespace omnihil::rem {
namespace {

std::size_t size_of(const RadioFormat& format, std::string_view name) {
  return static_cast<std::size_t>(format.find(name)->size_bytes);
}

// v5's commands and v8's test commands have a bit that says: answer, but do not act.
bool only_asks_for_an_answer(const Values& values) {
  const int index = values.message->field_index("feedback");
  return index >= 0 && values.fields[static_cast<std::size_t>(index)].number != 0.0;
}

}  // namespace

AnswerSizes::AnswerSizes(const RadioFormat& format)
    : feedback(size_of(format, "REM_RobotFeedback")),
      state_info(size_of(format, "REM_RobotStateInfo")),
      gains(size_of(format, "REM_RobotPIDGains")),
      ack(size_of(format, "REM_RobotAssuredAck")) {}

std::optional<Delivery> RadioEnd::receive(const Values& values) {
  const std::string_view name = values.message->name;
  Delivery delivery;
  delivery.robot_id = id_;
  delivery.message = name;
  if (name == "REM_RobotCommand" || name == "REM_RobotCommandTesting") {
    sends_state_info_ = wants_state_info(values);
    command_id_ = static_cast<std::uint8_t>(values.number("messageId"));
    if (only_asks_for_an_answer(values)) return std::nullopt;
    delivery.command = to_command(values);
    return delivery;
  }
  if (name == "REM_RobotKillCommand") return delivery;  // all zero: coast
  if (name == "REM_RobotSetPIDGains") {
    delivery.kind = Delivery::Kind::kGains;
    delivery.gains = to_gains(values, state_.gains);
    return delivery;
  }
  if (name == "REM_RobotGetPIDGains") gains_asked_ = true;
  if (name == "REM_RobotAssuredPacket") {
    if (acks_.full()) acks_.pop();  // the oldest is lost; its sender repeats
    acks_.push(static_cast<std::uint8_t>(values.number("sequenceNumber")));
  }
  return std::nullopt;
}

void RadioEnd::set_state(const RobotFeedback& feedback, const RobotGains& gains) {
  has_state_ = true;
  state_.feedback = feedback;
  state_.gains = gains;
  const bool has_ball = (feedback.flags & OMNIHIL_FEEDBACK_DRIBBLER_SEES_BALL) != 0;
  if (!has_ball) state_.omega_dribbler_before_ball_rad_s = feedback.omega_dribbler_rad_s;
}

AnswerPlan RadioEnd::plan(const AnswerSizes& sizes) const {
  AnswerPlan plan;
  plan.bytes = sizes.feedback;
  plan.gains = gains_asked_;
  if (plan.gains) plan.bytes += sizes.gains;
  while (plan.acks < acks_.size() && plan.bytes + sizes.ack <= kAirBytes) {
    plan.bytes += sizes.ack;
    ++plan.acks;
  }
  plan.state_info = sends_state_info_ && plan.bytes + sizes.state_info <= kAirBytes;
  if (plan.state_info) plan.bytes += sizes.state_info;
  return plan;
}

}  // namespace omnihil::rem
