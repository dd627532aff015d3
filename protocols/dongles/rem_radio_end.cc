#include "protocols/dongles/rem_radio_end.h"

namespace omnihil::rem {
namespace {

std::size_t size_of(const RadioFormat& format, MessageRole role) {
  return static_cast<std::size_t>(message_of_role(format.messages, role)->size_bytes);
}

}  // namespace

AnswerSizes::AnswerSizes(const RadioFormat& format)
    : feedback(size_of(format, MessageRole::kFeedback)),
      state_info(size_of(format, MessageRole::kStateInfo)),
      gains(size_of(format, MessageRole::kGains)),
      ack(size_of(format, MessageRole::kAcknowledge)) {}

std::optional<Delivery> RadioEnd::receive(const Values& values) {
  Delivery delivery;
  delivery.robot_id = id_;
  delivery.message = values.message->name;
  switch (values.message->role) {
    case MessageRole::kCommand:
    case MessageRole::kSingleCommand:
      sends_state_info_ = wants_state_info(values);
      command_id_ = static_cast<std::uint8_t>(values.number("messageId"));
      // v5's commands and v8's test commands have a bit that says: answer, but do not act.
      if (values.number_or("feedback", 0.0) != 0.0) return std::nullopt;
      delivery.command = to_command(values);
      return delivery;
    case MessageRole::kKill:
      return delivery;  // all zero: coast
    case MessageRole::kSetGains:
      delivery.kind = Delivery::Kind::kGains;
      delivery.gains = to_gains(values, state_.gains);
      return delivery;
    case MessageRole::kGetGains:
      gains_asked_ = true;
      return std::nullopt;
    case MessageRole::kAnnounce:
      if (acks_.full()) acks_.pop();  // the oldest is lost; its sender repeats
      acks_.push(static_cast<std::uint8_t>(values.number("sequenceNumber")));
      return std::nullopt;
    default:
      return std::nullopt;
  }
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
