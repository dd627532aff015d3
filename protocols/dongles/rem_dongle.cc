// RoboTeam Twente's base station and the radio ends of its robots, for both versions of REM.
//
//   host -> RemStream -> latest command and queue per robot -> 960 Hz slots -> robot -> answer -> host
//
// Cannot: lose packets on the air, or show what a channel busy with another team does.
#include <cassert>
#include <cstdio>
#include <utility>

#include "protocols/dongles/dongles.h"
#include "protocols/dongles/rem_air.h"
#include "protocols/dongles/rem_radio_end.h"
#include "protocols/dongles/rem_stream.h"
#include "protocols/dongles/ring.h"

namespace omnihil {
namespace {

using rem::AirPacket;
using rem::Packet;

constexpr std::size_t kHostBuffer = 65536;  // bytes waiting for the host; more are dropped as overrun
constexpr std::size_t kInFlight = 64;       // air packets and answers under way
constexpr std::int64_t kHeartbeat_ns = 1'000'000'000;

// What the base station holds for one robot.
struct Robot {
  bool exists = false;
  bool has_command = false;
  bool has_kill = false;
  Packet command;
  Packet kill;
  Ring<Packet, rem::kQueue> queue;
  rem::RadioEnd radio;

  bool idle() const { return !has_command && !has_kill && queue.empty(); }
};

struct Answer {
  int robot = 0;
  std::int64_t asked_ns = 0;
};

class RemDongle final : public RadioLink {
 public:
  RemDongle(const RadioFormat& format, const RadioLinkConfig& config)
      : format_(format),
        config_(config),
        telemetry_(format),
        answer_sizes_(format),
        header_bytes_(static_cast<std::size_t>(format.find("REM_Packet")->size_bytes)),
        stream_(format, from_host_),
        channel_(config.team) {
    for (const int id : config.robot_ids) {
      Robot& robot = robots_.at(static_cast<std::size_t>(id));  // ids beyond are the caller's mistake
      robot.exists = true;
      robot.radio = rem::RadioEnd(id);
    }
    host_out_.reserve(kHostBuffer);
  }

  void host_bytes(std::span<const std::uint8_t> bytes, std::int64_t now_ns) override {
    run_slots(now_ns - 1);  // a slot before now cannot carry what comes now
    stream_.feed(bytes, now_ns, [&](std::span<const std::uint8_t> packet, const Values& values) {
      from_host_.count(route(packet, values, now_ns));
    });
    report_refusal(now_ns);
  }

  void poll(std::int64_t now_ns, RadioSink& sink) override {
    stream_.expire(now_ns);
    for (bool more = true; more;) {
      more = run_slots(now_ns);
      while (!in_flight_.empty() && in_flight_.front().arrives_ns <= now_ns) {
        deliver(in_flight_.front(), sink);
        in_flight_.pop();
      }
    }
    heartbeat(now_ns);
  }

  void robot_frame(int robot_id, std::span<const std::uint8_t> frame, std::int64_t) override {
    const DecodeResult result = format_.decode(frame);
    PacketError error = result.error;
    if (error == PacketError::kNone && result.values.message->direction == Direction::kToRobot) {
      error = PacketError::kDirection;
    }
    const bool known =
        robot_id >= 0 && robot_id < rem::kIds && robots_[static_cast<std::size_t>(robot_id)].exists;
    if (error == PacketError::kNone && !known) error = PacketError::kAddress;
    if (error == PacketError::kNone && !to_host(frame)) error = PacketError::kOverrun;
    from_robots_.count(error);
  }

  void robot_feedback(int robot_id, const RobotFeedback& feedback, const RobotGains& gains,
                      std::int64_t) override {
    if (robot_id < 0 || robot_id >= rem::kIds) return;
    robots_[static_cast<std::size_t>(robot_id)].radio.set_state(feedback, gains);
  }

  void take_host_bytes(std::int64_t now_ns, std::vector<std::uint8_t>& out) override {
    while (!answers_.empty()) {
      const Answer answer = answers_.front();
      if (!answer_if_due(answer, now_ns)) break;
      answers_.pop();
    }
    out.insert(out.end(), host_out_.begin(), host_out_.end());
    host_out_.clear();
  }

  void host_closed(std::int64_t) override {
    stream_.close();
    host_out_.clear();
  }

  const PacketCounts& from_host() const override { return from_host_; }
  const PacketCounts& from_robots() const override { return from_robots_; }

 private:
  PacketError route(std::span<const std::uint8_t> packet, const Values& values, std::int64_t now_ns);
  PacketError route_to_robots(std::span<const std::uint8_t> packet, const Values& values);
  PacketError keep_for(Robot& robot, std::span<const std::uint8_t> packet, const Values& values);
  PacketError base_station_packet(const Values& values, std::int64_t now_ns);
  bool run_slots(std::int64_t until_ns);
  bool all_idle() const;
  void send_slot(int id, std::int64_t slot_ns);
  void deliver(const AirPacket& air, RadioSink& sink);
  bool answer_if_due(const Answer& answer, std::int64_t now_ns);
  void report_refusal(std::int64_t now_ns);
  void heartbeat(std::int64_t now_ns);
  void log_line(std::string_view text, std::int64_t now_ns);
  bool send_values(const Values& values);
  bool to_host(std::span<const std::uint8_t> bytes);
  rem::Header header(int id, std::int64_t now_ns) const;
  rem::Header own_header(std::int64_t now_ns) const;

  const RadioFormat& format_;
  RadioLinkConfig config_;
  rem::Telemetry telemetry_;
  rem::AnswerSizes answer_sizes_;
  std::size_t header_bytes_;
  PacketCounts from_host_;
  PacketCounts from_robots_;
  RemStream stream_;
  Team channel_;  // the two teams' robots listen on different channels
  std::array<Robot, rem::kIds> robots_{};
  std::int64_t next_slot_ = 0;
  std::int64_t next_heartbeat_ns_ = kHeartbeat_ns;
  std::uint64_t answered_ = 0;
  Ring<AirPacket, kInFlight> in_flight_;
  Ring<Answer, kInFlight> answers_;
  Values scratch_;
  std::vector<std::uint8_t> encoded_;
  std::vector<std::uint8_t> host_out_;
};

// --- from the host ---------------------------------------------------------------------------------------

PacketError RemDongle::route(std::span<const std::uint8_t> packet, const Values& values,
                             std::int64_t now_ns) {
  const Message& message = *values.message;
  if (message.name == "REM_SX1280Filler") return PacketError::kNone;
  const bool only_robots_send =
      message.direction == Direction::kFromRobot || message.direction == Direction::kFromDongle;
  if (only_robots_send && !message.text_tail) return PacketError::kDirection;
  if (values.flag("toPC")) return to_host(packet) ? PacketError::kNone : PacketError::kOverrun;
  if (values.flag("toBS")) return base_station_packet(values, now_ns);
  return route_to_robots(packet, values);
}

PacketError RemDongle::route_to_robots(std::span<const std::uint8_t> packet, const Values& values) {
  const bool base_station_only = values.message->name == "REM_BasestationConfiguration" ||
                                 values.message->direction == Direction::kToDongle;
  const Team to = values.flag("toColor") ? Team::kBlue : Team::kYellow;
  if (base_station_only || to != config_.team || channel_ != config_.team) return PacketError::kAddress;
  if (packet.size() > rem::kAirBytes) return PacketError::kTooLong;
  if (!values.flag("toBC")) {
    return keep_for(robots_[static_cast<std::size_t>(values.number("toRobotId"))], packet, values);
  }
  PacketError error = config_.robot_ids.empty() ? PacketError::kAddress : PacketError::kNone;
  for (const int id : config_.robot_ids) {
    const PacketError one = keep_for(robots_[static_cast<std::size_t>(id)], packet, values);
    if (one != PacketError::kNone) error = one;
  }
  return error;
}

// The latest command and the latest kill have a place each; everything else queues.
PacketError RemDongle::keep_for(Robot& robot, std::span<const std::uint8_t> packet, const Values& values) {
  if (!robot.exists) return PacketError::kAddress;
  Packet kept;
  kept.size = static_cast<std::uint8_t>(packet.size());
  std::copy(packet.begin(), packet.end(), kept.bytes.begin());
  if (values.message->name == "REM_RobotCommand") {
    robot.command = kept;
    robot.has_command = true;
    return PacketError::kNone;
  }
  if (values.message->name == "REM_RobotKillCommand") {
    robot.kill = kept;
    robot.has_kill = true;
    return PacketError::kNone;
  }
  return robot.queue.push(kept) ? PacketError::kNone : PacketError::kOverrun;
}

PacketError RemDongle::base_station_packet(const Values& values, std::int64_t now_ns) {
  if (values.message->name == "REM_BasestationConfiguration") {
    channel_ = values.flag("channel") ? Team::kBlue : Team::kYellow;
    return PacketError::kNone;
  }
  if (values.message->name != "REM_BasestationGetConfiguration") {
    return values.message->text_tail || values.message->name == "REM_Packet" ? PacketError::kNone
                                                                             : PacketError::kAddress;
  }
  telemetry_.start("REM_BasestationConfiguration", own_header(now_ns), scratch_);
  scratch_.set("channel", channel_ == Team::kBlue ? 1.0 : 0.0);
  return send_values(scratch_) ? PacketError::kNone : PacketError::kOverrun;
}

// --- slots and air ---------------------------------------------------------------------------------------

bool RemDongle::all_idle() const {
  for (const Robot& robot : robots_) {
    if (!robot.idle()) return false;
  }
  return true;
}

// Runs the timer up to and with `until_ns`. True: it stopped early, because too much is on the air.
bool RemDongle::run_slots(std::int64_t until_ns) {
  while (rem::slot_start_ns(next_slot_) <= until_ns) {
    if (all_idle()) {  // nothing to send in any slot: go on to the first one after until_ns
      next_slot_ = until_ns / 1'000'000'000 * rem::kSlotsPerSecond +
                   until_ns % 1'000'000'000 * rem::kSlotsPerSecond / 1'000'000'000;
      while (rem::slot_start_ns(next_slot_) <= until_ns) ++next_slot_;
      return false;
    }
    if (in_flight_.full()) return true;
    send_slot(static_cast<int>(next_slot_ % rem::kIds), rem::slot_start_ns(next_slot_));
    ++next_slot_;
  }
  return false;
}

void RemDongle::send_slot(int id, std::int64_t slot_ns) {
  Robot& robot = robots_[static_cast<std::size_t>(id)];
  if (robot.idle()) return;
  AirPacket air;
  air.robot = id;
  if (robot.has_command) air.append(robot.command);
  if (robot.has_kill) air.append(robot.kill);
  robot.has_command = robot.has_kill = false;
  while (!robot.queue.empty() && air.has_room_for(robot.queue.front())) {
    air.append(robot.queue.front());
    robot.queue.pop();
  }
  air.arrives_ns = slot_ns + rem::air_time_ns(air.size);
  in_flight_.push(air);
}

void RemDongle::deliver(const AirPacket& air, RadioSink& sink) {
  rem::RadioEnd& radio = robots_[static_cast<std::size_t>(air.robot)].radio;
  // The packets were cut out of the host's stream by the length that the header's last byte gives.
  for (std::size_t at = 0; at < air.size; at += air.bytes[at + header_bytes_ - 1]) {
    const auto bytes = std::span(air.bytes).subspan(at, air.bytes[at + header_bytes_ - 1]);
    const DecodeResult result = format_.decode(bytes);
    assert(result.error == PacketError::kNone);
    if (config_.firmware_decodes) {
      Delivery delivery;
      delivery.kind = Delivery::Kind::kFrame;
      delivery.robot_id = air.robot;
      delivery.frame = bytes;
      delivery.message = result.values.message->name;
      sink.deliver(delivery, air.arrives_ns);
    } else if (const std::optional<Delivery> delivery = radio.receive(result.values)) {
      sink.deliver(*delivery, air.arrives_ns);
    }
  }
  if (config_.firmware_decodes || !radio.has_state()) return;
  if (!answers_.push({.robot = air.robot, .asked_ns = air.arrives_ns}))
    from_robots_.count(PacketError::kOverrun);
}

// --- to the host -----------------------------------------------------------------------------------------

rem::Header RemDongle::header(int id, std::int64_t now_ns) const {
  return {.from_robot = id,
          .team = config_.team,
          .time_ms = config_.epoch_ms + static_cast<std::uint64_t>(now_ns / 1'000'000)};
}

rem::Header RemDongle::own_header(std::int64_t now_ns) const {
  rem::Header own = header(0, now_ns);
  own.team = Team::kYellow;  // the base station has no colour; its bit stays 0
  own.from_base_station = true;
  return own;
}

bool RemDongle::answer_if_due(const Answer& answer, std::int64_t now_ns) {
  rem::RadioEnd& radio = robots_[static_cast<std::size_t>(answer.robot)].radio;
  const rem::AnswerPlan plan = radio.plan(answer_sizes_);
  const std::int64_t after_ns = rem::kTurnaround_ns + rem::air_time_ns(plan.bytes);
  const std::int64_t due_ns = answer.asked_ns + std::min(after_ns, rem::kAnswerWindow_ns);
  if (due_ns > now_ns) return false;
  radio.answer(plan, telemetry_, header(answer.robot, due_ns), scratch_, [this](const Values& packet) {
    from_robots_.count(send_values(packet) ? PacketError::kNone : PacketError::kOverrun);
  });
  ++answered_;
  return true;
}

void RemDongle::report_refusal(std::int64_t now_ns) {
  const PacketError refusal = stream_.take_refusal();
  if (refusal == PacketError::kNone) return;
  char text[96];
  const std::string_view cause = to_string(refusal);
  const int length =
      std::snprintf(text, sizeof text, "base station: bad packet (%.*s), rest of the transfer dropped\n",
                    static_cast<int>(cause.size()), cause.data());
  log_line({text, static_cast<std::size_t>(length)}, now_ns);
}

void RemDongle::heartbeat(std::int64_t now_ns) {
  if (now_ns < next_heartbeat_ns_) return;
  next_heartbeat_ns_ = (now_ns / kHeartbeat_ns + 1) * kHeartbeat_ns;
  char text[128];
  const int length = std::snprintf(
      text, sizeof text, "base station: %llu packets from host, %llu refused, %llu answers\n",
      static_cast<unsigned long long>(from_host_.good), static_cast<unsigned long long>(from_host_.refused()),
      static_cast<unsigned long long>(answered_));
  log_line({text, static_cast<std::size_t>(length)}, now_ns);
}

// The base station's own words reach the host as REM_Log packets.
void RemDongle::log_line(std::string_view text, std::int64_t now_ns) {
  telemetry_.start("REM_Log", own_header(now_ns), scratch_);
  scratch_.text = text;
  send_values(scratch_);
}

bool RemDongle::send_values(const Values& values) {
  encoded_.clear();
  const RadioFormat::EncodeResult result = format_.encode(values, encoded_);
  assert(result.error == PacketError::kNone);
  static_cast<void>(result);
  return to_host(encoded_);
}

bool RemDongle::to_host(std::span<const std::uint8_t> bytes) {
  if (host_out_.size() + bytes.size() > kHostBuffer) return false;
  host_out_.insert(host_out_.end(), bytes.begin(), bytes.end());
  return true;
}

}  // namespace

std::unique_ptr<RadioLink> make_rem_dongle(const RadioFormat& format, const RadioLinkConfig& config) {
  return std::make_unique<RemDongle>(format, config);
}

}  // namespace omnihil
