// What a RoboTeam robot's radio end remembers between the air packets: whether state info is wanted, what was
// asked for once, and its own latest state. It turns a packet into a delivery and an air packet into an
// answer.
//
//   if (auto delivery = end.receive(values)) …                // for the firmware
//   const auto plan = end.plan(sizes);                        // what the answer will hold, and its length
//   end.answer(plan, telemetry, header, scratch, [&](const Values& packet) { … });
//
// Source: microcontroller6.0 5bfe578, Wireless_SendPacket. There the answer may grow past the 127 bytes of an
// air packet; here what was asked for once goes first, and state info waits for the next answer.
#pragma once
#include <cstdint>
#include <optional>

#include "protocols/dongles/rem_air.h"
#include "protocols/dongles/rem_robot.h"
#include "protocols/dongles/ring.h"

namespace omnihil::rem {

// Lengths of the packets of an answer.
struct AnswerSizes {
  std::size_t feedback = 0;
  std::size_t state_info = 0;
  std::size_t gains = 0;
  std::size_t ack = 0;
  explicit AnswerSizes(const RadioFormat& format);
};

struct AnswerPlan {
  bool state_info = false;
  bool gains = false;
  std::size_t acks = 0;
  std::size_t bytes = 0;
};

class RadioEnd {
 public:
  RadioEnd() = default;
  explicit RadioEnd(int id) : id_(id) {}

  // A packet that reached the robot. Empty: nothing for the firmware.
  std::optional<Delivery> receive(const Values& values);
  void set_state(const RobotFeedback& feedback, const RobotGains& gains);
  bool has_state() const { return has_state_; }

  AnswerPlan plan(const AnswerSizes& sizes) const;

  // Hands each packet of the answer to send(values). RobotFeedback gives the latest command's messageId back;
  // the others count their own.
  template <class Send>
  void answer(const AnswerPlan& plan, const Telemetry& telemetry, Header header, Values& scratch,
              Send&& send) {
    header.message_id = command_id_;
    telemetry.robot_feedback(state_, header, scratch);
    send(scratch);
    if (plan.state_info) {
      header.message_id = next_id_++;
      telemetry.robot_state_info(state_, header, scratch);
      send(scratch);
    }
    if (plan.gains) {
      header.message_id = next_id_++;
      telemetry.robot_gains(state_, header, scratch);
      send(scratch);
      gains_asked_ = false;
    }
    for (std::size_t i = 0; i < plan.acks; ++i) {
      header.message_id = next_id_++;
      telemetry.start(MessageRole::kAcknowledge, header, scratch);
      scratch.set("sequenceNumber", acks_.front());
      acks_.pop();
      send(scratch);
    }
  }

 private:
  int id_ = 0;
  bool has_state_ = false;
  RobotState state_;
  bool sends_state_info_ = false;
  bool gains_asked_ = false;
  std::uint8_t command_id_ = 0;
  std::uint8_t next_id_ = 0;
  // As many as one slot can bring, and as many again that found no room in the answer before.
  Ring<std::uint8_t, 24> acks_;
};

}  // namespace omnihil::rem
