// RoboCup ULaval's dongle and the radio ends of its robots.
//
//   host -> DelimitedStream -> queue -> one frame at a time over the air -> robot -> answer -> host
//
// What the air makes late (radio_air.h) is late behind the robot's radio, which has acknowledged it in time; an answer
// that is not back within the wait is one that nobody waits for.
// Cannot: repeat the radio's mistaking of a new frame for a repetition (the robot acts once on each frame; the second
// transmission only takes its time).
#include "protocols/dongles/hermes_dongle.h"

#include <algorithm>
#include <cassert>

#include "protocols/dongles/air_queue.h"
#include "protocols/dongles/delimited_stream.h"
#include "protocols/dongles/dongle.h"
#include "protocols/dongles/hermes_air.h"
#include "protocols/dongles/hermes_robot.h"
#include "protocols/dongles/kept_packet.h"
#include "protocols/dongles/ring.h"
#include "protocols/dongles/robot_table.h"

namespace omnihil {
namespace {

constexpr std::size_t kHostBuffer = 16384;  // bytes waiting for the host; more are dropped as overrun

struct Frame {
  KeptPacket<hermes::kPayloadBytes> packet;
  const Message* message = nullptr;
  int robot = 0;
  bool reaches_robot = false;
  int tries = 0;  // waits for an answer; 0: the type has none
  std::int64_t arrived_ns = 0;
};

// A frame that the robot's radio has, on its way to those who read it.
struct Arriving {
  Frame frame;
  std::uint64_t number = 0;  // of the frame the dongle has on the air
  std::int64_t at_ns = 0;
};

struct Robot {
  std::optional<RobotFeedback> feedback;
  HermesRobot radio;
};

class HermesDongle final : public Dongle {
 public:
  HermesDongle(const RadioFormat& format, const RadioLinkConfig& config)
      : Dongle(format, config, kHostBuffer),
        stream_(static_cast<std::size_t>(format.max_frame_bytes), from_host_),
        robots_(config.robot_ids),
        late_(air_room()) {
    assert(static_cast<std::size_t>(format.max_frame_bytes) <= hermes::kPayloadBytes);
  }

  void host_bytes(std::span<const std::uint8_t> bytes, std::int64_t now_ns) override {
    stream_.feed(bytes,
                 [&](std::span<const std::uint8_t> frame) { from_host_.count(accept(frame, now_ns)); });
  }

  void poll(std::int64_t now_ns, RadioSink& sink) override {
    while (step(now_ns, sink)) {
    }
    arrive(now_ns, sink);
  }

  // Radios send payloads of one length: what stands behind the delimiter is padding.
  void robot_frame(int robot_id, std::span<const std::uint8_t> payload, std::int64_t now_ns) override {
    const auto delimiter = std::find(payload.begin(), payload.end(), std::uint8_t{0});
    const auto frame = delimiter == payload.end() ? payload : payload.first(delimiter - payload.begin() + 1);
    PacketError error = fault_from_robot(frame);
    if (error == PacketError::kNone) error = take_answer(robot_id, frame, now_ns);
    if (error != PacketError::kNone) from_robots_.count(error);
  }

  void robot_feedback(int robot_id, const RobotFeedback& feedback, const RobotGains&, std::int64_t) override {
    if (Robot* robot = robots_.find(robot_id)) robot->feedback = feedback;
  }

  void host_closed(std::int64_t now_ns) override {
    stream_.close();
    Dongle::host_closed(now_ns);
  }

 private:
  enum class Phase : std::uint8_t { kIdle, kOnAir, kAcknowledge, kAwait };

  PacketError accept(std::span<const std::uint8_t> bytes, std::int64_t now_ns);
  PacketError take_answer(int robot_id, std::span<const std::uint8_t> frame, std::int64_t now_ns);
  bool step(std::int64_t now_ns, RadioSink& sink);
  void transmit(std::int64_t start_ns);
  void leave_dongle(RadioSink& sink);
  void arrive(std::int64_t now_ns, RadioSink& sink);
  void reach_robot(Arriving at, RadioSink& sink);
  void finish(std::int64_t at_ns);
  void end_of_wait();

  DelimitedStream stream_;
  RobotTable<Robot, 256> robots_;
  AirQueue<Arriving> late_;  // as the air brings them
  std::uint64_t number_ = 0;
  Ring<Frame, hermes::kQueueFrames> queue_;
  hermes::RepeatRule repeat_rule_;

  Phase phase_ = Phase::kIdle;
  std::int64_t free_ns_ = 0;      // the channel is free from here on
  std::int64_t reached_ns_ = 0;   // the frame on the air is at the robot
  std::int64_t end_ns_ = 0;       // its acknowledgement is over, or was missed
  std::int64_t deadline_ns_ = 0;  // of the answer
  int tries_left_ = 0;
  bool answered_ = false;
  std::int64_t answer_ns_ = 0;  // the answer is at the dongle
  std::vector<std::uint8_t> answer_;
};

// What the dongle takes from the host. A refused frame takes no time on the air.
PacketError HermesDongle::accept(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
  const DecodeResult result = format_.decode(bytes);
  if (result.error != PacketError::kNone) return result.error;
  const Message& message = *result.values.message;
  if (never_from_host(message)) return PacketError::kDirection;
  Frame frame;
  frame.packet = KeptPacket<hermes::kPayloadBytes>::of(bytes);
  frame.message = &message;
  frame.robot = address_of(result.values).robot;
  frame.reaches_robot = robots_.find(frame.robot) != nullptr;
  if (message.answer_type != 0) frame.tries = hermes::tries(message.type);
  frame.arrived_ns = now_ns;
  if (!queue_.push(frame)) return PacketError::kOverrun;
  return frame.reaches_robot ? PacketError::kNone : PacketError::kAddress;
}

// One event of the channel that is due by now. False: nothing more is.
bool HermesDongle::step(std::int64_t now_ns, RadioSink& sink) {
  switch (phase_) {
    case Phase::kIdle: {
      if (queue_.empty()) return false;
      const std::int64_t start_ns = std::max(free_ns_, queue_.front().arrived_ns);
      if (start_ns > now_ns) return false;
      tries_left_ = queue_.front().tries;
      answered_ = false;
      ++number_;
      transmit(start_ns);
      return true;
    }
    case Phase::kOnAir:
      if (reached_ns_ > now_ns) return false;
      leave_dongle(sink);
      phase_ = Phase::kAcknowledge;
      return true;
    case Phase::kAcknowledge:
      if (end_ns_ > now_ns) return false;
      if (queue_.front().tries == 0) {
        finish(end_ns_);
      } else {
        deadline_ns_ = end_ns_ + hermes::kAnswerTimeout_ns;
        phase_ = Phase::kAwait;
      }
      return true;
    case Phase::kAwait:
      if ((answered_ ? answer_ns_ : deadline_ns_) > now_ns) return false;
      end_of_wait();
      return true;
  }
  return false;
}

void HermesDongle::transmit(std::int64_t start_ns) {
  const Frame& frame = queue_.front();
  const std::int64_t ack_ns = frame.reaches_robot ? hermes::kAck_ns : hermes::kNoAck_ns;
  const bool twice = repeat_rule_.sends_twice(frame.robot);
  reached_ns_ = start_ns + hermes::kFrame_ns;
  end_ns_ = start_ns + (hermes::kFrame_ns + ack_ns) * (twice ? 2 : 1);
  phase_ = Phase::kOnAir;
}

void HermesDongle::leave_dongle(RadioSink& sink) {
  const Frame& frame = queue_.front();
  if (!frame.reaches_robot) return;
  through_air(frame.robot, AirWay::kToRobot, reached_ns_, [&](std::int64_t late_ns) {
    const Arriving at{.frame = frame, .number = number_, .at_ns = reached_ns_ + late_ns};
    if (config_.air == nullptr) return reach_robot(at, sink);
    if (!late_.push(at, at.at_ns)) crowded_out(AirWay::kToRobot);
  });
  arrive(reached_ns_, sink);
}

void HermesDongle::arrive(std::int64_t now_ns, RadioSink& sink) {
  for (; const Arriving* at = late_.due(now_ns); late_.pop()) reach_robot(*at, sink);
}

void HermesDongle::reach_robot(Arriving at, RadioSink& sink) {
  Frame& frame = at.frame;
  if (!survives(frame.robot, AirWay::kToRobot, frame.packet.span())) return;
  if (config_.firmware_decodes) {
    return deliver_frame(sink, frame.robot, *frame.message, frame.packet.span(), at.at_ns);
  }
  Robot& robot = *robots_.find(frame.robot);
  const Values values = format_.decode(frame.packet.span()).values;  // the robot's own reading
  if (const std::optional<RobotCommand> command = robot.radio.receive(values, at.at_ns)) {
    Delivery delivery;
    delivery.robot_id = frame.robot;
    delivery.message = values.message->name;
    delivery.command = *command;
    sink.deliver(delivery, at.at_ns);
  }
  if (frame.tries == 0 || !robot.feedback || values.message != frame.message) return;
  const bool waits = at.number == number_ && phase_ != Phase::kIdle;
  if (waits && answered_) return;
  through_air(frame.robot, AirWay::kToHost, at.at_ns, [&](std::int64_t late_ns) {
    const std::int64_t back_ns =
        std::max(end_ns_, at.at_ns + hermes::kRobotTurnaround_ns) + hermes::kFrame_ns + late_ns;
    if (!waits || answered_ || back_ns > end_ns_ + hermes::kAnswerTimeout_ns)
      return from_robots_.count(PacketError::kOverrun);
    answered_ = true;
    answer_.clear();
    answer_ns_ = back_ns;
  });
}

void HermesDongle::end_of_wait() {
  const Frame& frame = queue_.front();
  if (!answered_) {
    if (--tries_left_ == 0) return finish(deadline_ns_);
    // The dongle sends the request once more, without its repeat rule.
    reached_ns_ = deadline_ns_ + hermes::kFrame_ns;
    end_ns_ = reached_ns_ + (frame.reaches_robot ? hermes::kAck_ns : hermes::kNoAck_ns);
    phase_ = Phase::kOnAir;
    return;
  }
  const Robot* robot = robots_.find(frame.robot);
  if (!config_.firmware_decodes && robot != nullptr) {
    Values values;
    values.message = message_of_type(format_.messages, frame.message->answer_type);
    robot->radio.answer(frame.robot, robot->feedback.value_or(RobotFeedback{}), values);
    encode(values, answer_);
  }
  if (!survives(frame.robot, AirWay::kToHost, answer_)) {  // it waits on
    answered_ = false;
    return;
  }
  from_robots_.count(to_host(answer_));
  finish(answer_ns_);
}

void HermesDongle::finish(std::int64_t at_ns) {
  queue_.pop();
  free_ns_ = at_ns;
  phase_ = Phase::kIdle;
}

// An answer that the firmware itself sent. The dongle listens only while it waits for one.
PacketError HermesDongle::take_answer(int robot_id, std::span<const std::uint8_t> frame,
                                      std::int64_t now_ns) {
  if (phase_ == Phase::kIdle || queue_.front().tries == 0 || answered_) return PacketError::kOverrun;
  const bool first_on_its_way = phase_ == Phase::kOnAir && tries_left_ == queue_.front().tries;
  if (first_on_its_way) return PacketError::kOverrun;
  if (queue_.front().robot != robot_id) return PacketError::kAddress;
  const bool on_air = phase_ != Phase::kAwait;
  const std::int64_t back_ns = (on_air ? std::max(now_ns, end_ns_) : now_ns) + hermes::kFrame_ns;
  through_air(robot_id, AirWay::kToHost, now_ns, [&](std::int64_t late_ns) {
    const bool too_late = late_ns > 0 && back_ns + late_ns > end_ns_ + hermes::kAnswerTimeout_ns;
    if (answered_ || too_late) return from_robots_.count(PacketError::kOverrun);
    answered_ = true;
    answer_.assign(frame.begin(), frame.end());
    answer_ns_ = back_ns + late_ns;
  });
  return PacketError::kNone;
}

}  // namespace

std::unique_ptr<RadioLink> make_hermes_dongle(const RadioFormat& format, const RadioLinkConfig& config) {
  return std::make_unique<HermesDongle>(format, config);
}

}  // namespace omnihil
