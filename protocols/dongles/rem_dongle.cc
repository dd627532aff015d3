// RoboTeam Twente's base station and the radio ends of its robots, for both versions of REM.
//
//   host -> RemStream -> latest command and queue per robot -> 960 Hz slots -> robot -> answer -> host
//
// Cannot: show what a channel busy with another team does, but for what the air loses (radio_air.h).
#include "protocols/dongles/rem_dongle.h"

#include <algorithm>
#include <cassert>
#include <cstdio>

#include "protocols/dongles/air_queue.h"
#include "protocols/dongles/dongle.h"
#include "protocols/dongles/heartbeat.h"
#include "protocols/dongles/outbox.h"
#include "protocols/dongles/rem_air.h"
#include "protocols/dongles/rem_radio_end.h"
#include "protocols/dongles/rem_stream.h"
#include "protocols/dongles/ring.h"
#include "protocols/dongles/robot_table.h"

namespace omnihil {
namespace {

using rem::AirPacket;

constexpr std::size_t kHostBuffer = 65536;  // bytes waiting for the host; more are dropped as overrun
constexpr std::size_t kInFlight = 64;       // air packets and answers under way
constexpr std::int64_t kHeartbeat_ns = 1'000'000'000;

// What the base station holds for one robot.
struct Robot {
  Outbox<rem::kAirBytes, rem::kQueue> outbox;
  rem::RadioEnd radio;
};

struct Answer {
  int robot = 0;
  std::int64_t asked_ns = 0;
  AirFate way_back{};
};

struct Said {  // one packet of an answer
  int robot = 0;
  KeptPacket<255> packet;
};

class RemDongle final : public Dongle {
 public:
  RemDongle(const RadioFormat& format, const RadioLinkConfig& config)
      : Dongle(format, config, kHostBuffer),
        telemetry_(format),
        answer_sizes_(format),
        stream_(format, from_host_),
        channel_(config.team),
        robots_(config.robot_ids),
        late_to_robots_(air_room()),
        late_to_host_(air_room()) {
    for (const int id : config.robot_ids) robots_.find(id)->radio = rem::RadioEnd(id);
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
        cross(in_flight_.front(), sink);
        in_flight_.pop();
      }
    }
    arrive(now_ns, sink);
    if (heartbeat_.due(now_ns)) log_status(now_ns);
  }

  // A robot stitches the packets of its answer together, too.
  void robot_frame(int robot_id, std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    do {
      const std::size_t n = stream_.first_packet_bytes(frame);
      robot_packet(robot_id, frame.first(n), now_ns);
      frame = frame.subspan(n);
    } while (!frame.empty());
  }

  void robot_packet(int robot_id, std::span<const std::uint8_t> frame, std::int64_t now_ns) {
    PacketError error = fault_from_robot(frame);
    if (error == PacketError::kNone && robots_.find(robot_id) == nullptr) error = PacketError::kAddress;
    if (error != PacketError::kNone) return from_robots_.count(error);
    through_air(robot_id, AirWay::kToHost, now_ns,
                [&](std::int64_t late_ns) { say(robot_id, frame, now_ns + late_ns); });
  }

  void robot_feedback(int robot_id, const RobotFeedback& feedback, const RobotGains& gains,
                      std::int64_t) override {
    if (Robot* robot = robots_.find(robot_id)) robot->radio.set_state(feedback, gains);
  }

  void take_host_bytes(std::int64_t now_ns, std::vector<std::uint8_t>& out) override {
    while (!answers_.empty()) {
      const Answer answer = answers_.front();
      if (!answer_if_due(answer, now_ns)) break;
      answers_.pop();
    }
    for (; Said* said = late_to_host_.due(now_ns); late_to_host_.pop()) {
      if (survives(said->robot, AirWay::kToHost, said->packet.span()))
        from_robots_.count(to_host(said->packet.span()));
    }
    Dongle::take_host_bytes(now_ns, out);
  }

  void host_closed(std::int64_t now_ns) override {
    stream_.close();
    Dongle::host_closed(now_ns);
  }

 private:
  PacketError route(std::span<const std::uint8_t> packet, const Values& values, std::int64_t now_ns);
  PacketError route_to_robots(std::span<const std::uint8_t> packet, const Message& message,
                              const Address& address);
  PacketError keep_for(int id, std::span<const std::uint8_t> packet, const Message& message);
  PacketError base_station_packet(const Values& values, std::int64_t now_ns);
  bool run_slots(std::int64_t until_ns);
  bool all_idle() const;
  void send_slot(int id, std::int64_t slot_ns);
  void cross(const AirPacket& air, RadioSink& sink);
  void arrive(std::int64_t now_ns, RadioSink& sink);
  void deliver(const AirPacket& air, RadioSink& sink);
  void deliver_one(const AirPacket& air, std::span<const std::uint8_t> bytes, RadioSink& sink);
  void say(int robot, std::span<const std::uint8_t> packet, std::int64_t at_ns);
  bool answer_if_due(const Answer& answer, std::int64_t now_ns);
  void report_refusal(std::int64_t now_ns);
  void log_status(std::int64_t now_ns);
  void log_line(std::string_view text, std::int64_t now_ns);
  rem::Header header(int id, std::int64_t now_ns) const;
  rem::Header own_header(std::int64_t now_ns) const;

  rem::Telemetry telemetry_;
  rem::AnswerSizes answer_sizes_;
  RemStream stream_;
  Team channel_;  // the two teams' robots listen on different channels
  RobotTable<Robot, rem::kIds> robots_;
  std::int64_t next_slot_ = 0;
  Heartbeat heartbeat_{kHeartbeat_ns};
  std::uint64_t answered_ = 0;
  Ring<AirPacket, kInFlight> in_flight_;
  Ring<Answer, kInFlight> answers_;
  AirQueue<AirPacket> late_to_robots_;  // as the air brings them
  AirQueue<Said> late_to_host_;
  std::vector<std::uint8_t> said_;
  Values scratch_;
};

// --- from the host ---------------------------------------------------------------------------------------

PacketError RemDongle::route(std::span<const std::uint8_t> packet, const Values& values,
                             std::int64_t now_ns) {
  const Message& message = *values.message;
  if (message.role == MessageRole::kFiller) return PacketError::kNone;
  if (never_from_host(message) && message.role != MessageRole::kText) return PacketError::kDirection;
  const Address address = address_of(values);
  if (address.host) return to_host(packet);
  if (address.dongle) return base_station_packet(values, now_ns);
  return route_to_robots(packet, message, address);
}

PacketError RemDongle::route_to_robots(std::span<const std::uint8_t> packet, const Message& message,
                                       const Address& address) {
  const bool base_station_only =
      message.role == MessageRole::kConfigureDongle || message.direction == Direction::kToDongle;
  if (base_station_only || address.team != config_.team || channel_ != config_.team) {
    return PacketError::kAddress;
  }
  if (packet.size() > rem::kAirBytes) return PacketError::kTooLong;
  return for_addressed(address, [&](int id) { return keep_for(id, packet, message); });
}

PacketError RemDongle::keep_for(int id, std::span<const std::uint8_t> packet, const Message& message) {
  Robot* robot = robots_.find(id);
  if (robot == nullptr) return PacketError::kAddress;
  return robot->outbox.keep(message, packet) ? PacketError::kNone : PacketError::kOverrun;
}

PacketError RemDongle::base_station_packet(const Values& values, std::int64_t now_ns) {
  switch (values.message->role) {
    case MessageRole::kConfigureDongle:
      channel_ = values.flag("channel") ? Team::kBlue : Team::kYellow;
      return PacketError::kNone;
    case MessageRole::kAskDongle:
      telemetry_.start(MessageRole::kConfigureDongle, own_header(now_ns), scratch_);
      scratch_.set("channel", channel_ == Team::kBlue ? 1.0 : 0.0);
      return to_host(scratch_);
    case MessageRole::kText:
    case MessageRole::kHeaderOnly:
      return PacketError::kNone;
    default:
      return PacketError::kAddress;
  }
}

// --- slots and air ---------------------------------------------------------------------------------------

bool RemDongle::all_idle() const {
  return std::all_of(robots_.begin(), robots_.end(), [](const Robot& r) { return r.outbox.empty(); });
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
  Robot* robot = robots_.find(id);
  if (robot == nullptr || robot->outbox.empty()) return;
  AirPacket air;
  air.robot = id;
  while (const auto packet = robot->outbox.next(air.room())) air.append(packet->span());
  air.arrives_ns = slot_ns + rem::air_time_ns(air.size);
  in_flight_.push(air);
}

void RemDongle::cross(const AirPacket& air, RadioSink& sink) {
  through_air(air.robot, AirWay::kToRobot, air.arrives_ns, [&](std::int64_t late_ns) {
    if (config_.air == nullptr) return deliver(air, sink);
    AirPacket copy = air;
    copy.arrives_ns += late_ns;
    if (!late_to_robots_.push(copy, copy.arrives_ns)) crowded_out(AirWay::kToRobot);
  });
  arrive(air.arrives_ns, sink);
}

void RemDongle::arrive(std::int64_t now_ns, RadioSink& sink) {
  for (; const AirPacket* air = late_to_robots_.due(now_ns); late_to_robots_.pop()) deliver(*air, sink);
}

void RemDongle::deliver(const AirPacket& air, RadioSink& sink) {
  for (std::span<const std::uint8_t> rest = air.span(); !rest.empty();) {
    const auto bytes = rest.first(stream_.packet_bytes(rest));
    rest = rest.subspan(bytes.size());
    deliver_one(air, bytes, sink);
  }
  if (config_.firmware_decodes || !robots_.find(air.robot)->radio.has_state()) return;
  Answer answer{.robot = air.robot, .asked_ns = air.arrives_ns};
  if (config_.air != nullptr) answer.way_back = config_.air->fate(air.robot, AirWay::kToHost, air.arrives_ns);
  if (answer.way_back.copies == 0) return;
  if (!answers_.push(answer)) from_robots_.count(PacketError::kOverrun);
}

// Each packet of a stitched one is damaged and judged by itself.
void RemDongle::deliver_one(const AirPacket& air, std::span<const std::uint8_t> bytes, RadioSink& sink) {
  auto packet = KeptPacket<rem::kAirBytes>::of(bytes);
  if (!survives(air.robot, AirWay::kToRobot, packet.span())) return;
  if (config_.firmware_decodes) {
    deliver_frame(sink, air.robot, *message_of_type(format_.messages, bytes[0]), packet.span(),
                  air.arrives_ns);
    return;
  }
  rem::RadioEnd& radio = robots_.find(air.robot)->radio;
  if (const auto delivery = radio.receive(format_.decode(packet.span()).values))
    sink.deliver(*delivery, air.arrives_ns);
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
  rem::RadioEnd& radio = robots_.find(answer.robot)->radio;
  const rem::AnswerPlan plan = radio.plan(answer_sizes_);
  const std::int64_t after_ns = rem::kTurnaround_ns + rem::air_time_ns(plan.bytes);
  const std::int64_t due_ns = answer.asked_ns + std::min(after_ns, rem::kAnswerWindow_ns);
  if (due_ns > now_ns) return false;
  radio.answer(plan, telemetry_, header(answer.robot, due_ns), scratch_, [&](const Values& packet) {
    said_.clear();
    encode(packet, said_);
    for (int i = 0; i < answer.way_back.copies; ++i)
      say(answer.robot, said_, due_ns + answer.way_back.late_ns[static_cast<std::size_t>(i)]);
  });
  ++answered_;
  return true;
}

// A robot's packet is at the base station at this time.
void RemDongle::say(int robot, std::span<const std::uint8_t> packet, std::int64_t at_ns) {
  if (config_.air == nullptr) return from_robots_.count(to_host(packet));
  if (!late_to_host_.push({.robot = robot, .packet = KeptPacket<255>::of(packet)}, at_ns))
    crowded_out(AirWay::kToHost);
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

void RemDongle::log_status(std::int64_t now_ns) {
  char text[128];
  const int length = std::snprintf(
      text, sizeof text, "base station: %llu packets from host, %llu refused, %llu answers\n",
      static_cast<unsigned long long>(from_host_.good), static_cast<unsigned long long>(from_host_.refused()),
      static_cast<unsigned long long>(answered_));
  log_line({text, static_cast<std::size_t>(length)}, now_ns);
}

// The base station's own words reach the host as REM_Log packets.
void RemDongle::log_line(std::string_view text, std::int64_t now_ns) {
  telemetry_.start(MessageRole::kText, own_header(now_ns), scratch_);
  scratch_.text = text;
  static_cast<void>(to_host(scratch_));  // no room: this line is lost
}

}  // namespace

std::unique_ptr<RadioLink> make_rem_dongle(const RadioFormat& format, const RadioLinkConfig& config) {
  return std::make_unique<RemDongle>(format, config);
}

}  // namespace omnihil
