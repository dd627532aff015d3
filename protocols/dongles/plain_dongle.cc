#include "protocols/dongles/plain_dongle.h"

#include <algorithm>
#include <optional>

#include "protocols/dongles/air_queue.h"
#include "protocols/dongles/dongle.h"
#include "protocols/dongles/kept_packet.h"
#include "protocols/dongles/ring.h"
#include "protocols/dongles/robot_table.h"
#include "protocols/dongles/table_frames.h"
#include "protocols/meaning.h"
#include "protocols/packet_list.h"

namespace omnihil {
namespace {

constexpr std::size_t kHostBuffer = 16384;  // choice: ULaval's stick keeps as much
constexpr std::size_t kInFlight = 128;      // choice: 16 robots, eight frames each

struct InFlight {
  KeptPacket<255> packet;
  int robot = 0;  // -1: nobody, the turn of a list that names none
  std::int64_t arrives_ns = 0;
  bool ends_list = false;  // the answers to the list go back after this one
};

struct Robot {
  std::optional<RobotFeedback> feedback;   // none: it is still starting, and silent
  std::uint32_t kick = OMNIHIL_KICK_NONE;  // that the latest command asked for
  std::uint32_t kept = 0;                  // by PlainDongle::remember
  std::int64_t tells_ns = 0;               // when it next says something by itself
};

class PlainLink final : public Dongle {
 public:
  PlainLink(const RadioFormat& format, const RadioLinkConfig& config, const PlainDongle& plain)
      : Dongle(format, config, kHostBuffer),
        plain_(plain),
        stream_(plain.frame_bytes != nullptr ? FrameBytes(plain.frame_bytes)
                                             : frames_by_tables(format, plain.silent_line),
                from_host_),
        robots_(config.robot_ids),
        late_(air_room()),
        answers_(kInFlight + air_room()),
        late_listed_(air_room()) {
    answer_.reserve(static_cast<std::size_t>(format.max_frame_bytes));
    if (format.list != nullptr) listed_answers_.reserve(static_cast<std::size_t>(format.list->most));
  }

  void host_bytes(std::span<const std::uint8_t> bytes, std::int64_t now_ns) override {
    if (plain_.half_frame_ns > 0 && now_ns - last_byte_ns_ > plain_.half_frame_ns) stream_.close();
    last_byte_ns_ = now_ns;
    stream_.feed(bytes, [&](std::span<const std::uint8_t> frame) {
      if (!is_empty(format_, frame)) from_host_.count(accept(frame, now_ns));
    });
  }

  void poll(std::int64_t now_ns, RadioSink& sink) override {
    while (!to_robots_.empty() && to_robots_.front().arrives_ns <= now_ns) {
      leave_dongle(to_robots_.front(), sink);
      to_robots_.pop();
    }
    arrive(now_ns, sink);
  }

  void robot_frame(int robot_id, std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    PacketError error = fault_from_robot(frame);
    if (error == PacketError::kNone && robots_.find(robot_id) == nullptr) error = PacketError::kAddress;
    if (error == PacketError::kNone) error = send_back(robot_id, frame, now_ns);
    if (error != PacketError::kNone) from_robots_.count(error);
  }

  void robot_feedback(int robot_id, const RobotFeedback& feedback, const RobotGains&,
                      std::int64_t now_ns) override {
    Robot* robot = robots_.find(robot_id);
    if (robot == nullptr) return;
    robot->feedback = feedback;
    if (plain_.tell == nullptr || config_.firmware_decodes || now_ns < robot->tells_ns) return;
    robot->tells_ns = now_ns + plain_.tell_every_ns;
    Values out;
    plain_.tell(robot_id, feedback, out);
    say(robot_id, out, now_ns);
  }

  void take_host_bytes(std::int64_t now_ns, std::vector<std::uint8_t>& out) override {
    for (; InFlight* at = answers_.due(now_ns); answers_.pop()) {
      if (at->robot < 0 || survives(at->robot, AirWay::kToHost, at->packet.span()))
        from_robots_.count(to_host(at->packet.span()));
    }
    Dongle::take_host_bytes(now_ns, out);
  }

  void host_closed(std::int64_t now_ns) override {
    stream_.close();
    Dongle::host_closed(now_ns);
  }

 private:
  PacketError accept(std::span<const std::uint8_t> frame, std::int64_t now_ns);
  PacketError accept_list(std::span<const std::uint8_t> frame, std::int64_t now_ns);
  PacketError send_to(int id, std::span<const std::uint8_t> frame, std::int64_t at_ns, bool ends_list);
  void end_list(std::int64_t at_ns);
  PacketError send_back(int robot, std::span<const std::uint8_t> frame, std::int64_t now_ns);
  void say(int robot, const Values& values, std::int64_t now_ns);
  void leave_dongle(const InFlight& at, RadioSink& sink);
  void arrive(std::int64_t now_ns, RadioSink& sink);
  void reach_robot(InFlight at, RadioSink& sink);
  void list_answer(int robot, const Values& answer, std::int64_t now_ns);
  PacketError fault_to_robot(int robot, std::span<const std::uint8_t> packet) const override;
  void act(const Values& values, const InFlight& at, RadioSink& sink);
  bool answer(const Values& to_robot, int id, const RobotFeedback& feedback, Values& out) const {
    if (plain_.answer != nullptr) return plain_.answer(to_robot, id, feedback, out);
    return plain_.to_command == nullptr && answer_by_meaning(format_, to_robot, id, feedback, out);
  }

  PlainDongle plain_;
  SizedStream stream_;
  std::int64_t last_byte_ns_ = 0;
  RobotTable<Robot, 256> robots_;
  Ring<InFlight, kInFlight> to_robots_;
  AirQueue<InFlight> late_;  // to robots, as the air brings them
  AirQueue<InFlight> answers_;
  AirQueue<InFlight> late_listed_;  // answers for a list
  std::vector<std::uint8_t> answer_;
  std::vector<Values> listed_answers_;
  std::int64_t next_answer_ns_ = 0;
  std::int64_t list_done_ns_ = 0;  // the next list waits for the one before
};

PacketError PlainLink::send_to(int id, std::span<const std::uint8_t> frame, std::int64_t at_ns,
                               bool ends_list) {
  const bool is_there = robots_.find(id) != nullptr;
  if (!is_there && !ends_list) return plain_.to_everybody ? PacketError::kNone : PacketError::kAddress;
  const bool room = to_robots_.push({.packet = KeptPacket<255>::of(frame),
                                     .robot = is_there ? id : -1,
                                     .arrives_ns = at_ns,
                                     .ends_list = ends_list});
  if (!room) return PacketError::kOverrun;
  return is_there ? PacketError::kNone : PacketError::kAddress;
}

PacketError PlainLink::accept(std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  if (!plain_.silent_line.empty() &&
      std::equal(frame.begin(), frame.end(), plain_.silent_line.begin(), plain_.silent_line.end())) {
    if (plain_.line_answer == nullptr || config_.robot_ids.size() != 1) return PacketError::kNone;
    answer_.clear();
    plain_.line_answer(config_.robot_ids.front(), answer_);
    return send_back(-1, answer_, now_ns);
  }
  const auto listed = listed_packets(format_, frame);
  if (format_.list != nullptr && listed) return accept_list(frame, now_ns);
  const DecodeResult result = format_.decode(frame);
  if (result.error != PacketError::kNone) return result.error;
  if (never_from_host(*result.values.message)) return PacketError::kDirection;
  if (result.values.message->direction == Direction::kToDongle) {
    Values out;
    if (plain_.dongle_answer == nullptr || !plain_.dongle_answer(result.values, out))
      return PacketError::kNone;
    answer_.clear();
    encode(out, answer_);
    return send_back(-1, answer_, now_ns);
  }
  const auto send = [&](int id) { return send_to(id, frame, now_ns + plain_.to_robot_ns, false); };
  if (plain_.robots != nullptr) {
    std::array<int, 16> ids{};
    PacketError error = PacketError::kNone;
    const std::size_t count = plain_.robots(result.values, ids);
    for (std::size_t i = 0; i < count; ++i) {
      const PacketError one = send(ids[i]);
      if (one != PacketError::kNone) error = one;
    }
    return error;
  }
  const Address address = address_of(result.values);
  if (address.team.value_or(config_.team) != config_.team) return PacketError::kAddress;
  return for_addressed(address, send);
}

// Each packet by itself to its robot, one turn after the other.
PacketError PlainLink::accept_list(std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  const std::size_t count = *listed_packets(format_, frame);
  for (std::size_t i = 0; i < count; ++i) {
    const DecodeResult result = decode_listed(format_, frame, i);
    if (result.error != PacketError::kNone) return result.error;
    if (never_from_host(*result.values.message)) return PacketError::kDirection;
  }
  std::int64_t at_ns = std::max(now_ns, list_done_ns_) + plain_.to_robot_ns;
  PacketError error = PacketError::kNone;
  for (std::size_t i = 0; i < count; ++i, at_ns += plain_.turn_ns) {
    const Values values = decode_listed(format_, frame, i).values;
    answer_.clear();
    encode(values, answer_);
    const PacketError one = send_to(address_of(values).robot, answer_, at_ns, i + 1 == count);
    if (one != PacketError::kNone) error = one;
  }
  if (count == 0) send_to(-1, {}, at_ns, true);
  list_done_ns_ = count == 0 ? now_ns : at_ns - plain_.to_robot_ns;
  return error;
}

void PlainLink::end_list(std::int64_t at_ns) {
  for (; InFlight* at = late_listed_.due(at_ns); late_listed_.pop()) {
    if (!survives(at->robot, AirWay::kToHost, at->packet.span())) continue;
    if (listed_answers_.size() < static_cast<std::size_t>(format_.list->most))
      listed_answers_.push_back(format_.decode(at->packet.span()).values);
  }
  answer_.clear();
  if (encode_list(format_, listed_answers_, answer_).error == PacketError::kNone) {
    const PacketError error = send_back(-1, answer_, at_ns);
    if (error != PacketError::kNone) from_robots_.count(error);
  }
  listed_answers_.clear();
}

void PlainLink::leave_dongle(const InFlight& at, RadioSink& sink) {
  if (at.robot >= 0) {
    through_air(at.robot, AirWay::kToRobot, at.arrives_ns, [&](std::int64_t late_ns) {
      if (config_.air == nullptr) return reach_robot(at, sink);
      InFlight copy = at;
      copy.arrives_ns += late_ns;
      if (!late_.push(copy, copy.arrives_ns)) crowded_out(AirWay::kToRobot);
    });
    arrive(at.arrives_ns, sink);
  }
  if (at.ends_list && !config_.firmware_decodes) end_list(at.arrives_ns + plain_.turn_ns);
}

void PlainLink::arrive(std::int64_t now_ns, RadioSink& sink) {
  for (; const InFlight* at = late_.due(now_ns); late_.pop()) reach_robot(*at, sink);
}

PacketError PlainLink::fault_to_robot(int robot, std::span<const std::uint8_t> packet) const {
  const PacketError error = Dongle::fault_to_robot(robot, packet);
  if (error != PacketError::kNone || plain_.robots == nullptr) return error;
  std::array<int, 16> ids{};
  const auto end =
      ids.begin() + static_cast<std::ptrdiff_t>(plain_.robots(format_.decode(packet).values, ids));
  return std::find(ids.begin(), end, robot) == end ? PacketError::kAddress : PacketError::kNone;
}

void PlainLink::reach_robot(InFlight at, RadioSink& sink) {
  const Message* sent = config_.firmware_decodes ? format_.decode(at.packet.span()).values.message : nullptr;
  if (!survives(at.robot, AirWay::kToRobot, at.packet.span())) return;
  if (config_.firmware_decodes) {
    deliver_frame(sink, at.robot, *sent, at.packet.span(), at.arrives_ns);
  } else {
    act(format_.decode(at.packet.span()).values, at, sink);
  }
}

// What a robot whose firmware takes commands does with a packet.
void PlainLink::act(const Values& values, const InFlight& at, RadioSink& sink) {
  const MessageRole role = values.message->role;
  const bool drives = role == MessageRole::kCommand || role == MessageRole::kSingleCommand;
  if (drives || role == MessageRole::kKill) {
    Delivery delivery;
    delivery.robot_id = at.robot;
    delivery.message = values.message->name;
    if (drives) {
      delivery.command =
          plain_.to_command == nullptr ? command_by_meaning(values) : plain_.to_command(values, at.robot);
    }
    std::uint32_t& kick_before = robots_.find(at.robot)->kick;
    const std::uint32_t kick = delivery.command.kick;
    if (plain_.kicks_once && kick == kick_before) delivery.command.kick = OMNIHIL_KICK_NONE;
    kick_before = kick;
    sink.deliver(delivery, at.arrives_ns);
  }
  const std::optional<RobotFeedback>& feedback = robots_.find(at.robot)->feedback;
  Values out;
  if (!feedback || !answer(values, at.robot, *feedback, out)) return;
  if (plain_.remember != nullptr) plain_.remember(values, robots_.find(at.robot)->kept, out);
  if (format_.list != nullptr) return list_answer(at.robot, out, at.arrives_ns);
  say(at.robot, out, at.arrives_ns);
}

void PlainLink::say(int robot, const Values& values, std::int64_t now_ns) {
  answer_.clear();
  encode(values, answer_);
  const PacketError error = send_back(robot, answer_, now_ns);
  if (error != PacketError::kNone) from_robots_.count(error);
}

// For the list that ends next after it has come.
void PlainLink::list_answer(int robot, const Values& answer, std::int64_t now_ns) {
  if (config_.air == nullptr) {
    if (listed_answers_.size() < static_cast<std::size_t>(format_.list->most))
      listed_answers_.push_back(answer);
    return;
  }
  answer_.clear();
  encode(answer, answer_);
  through_air(robot, AirWay::kToHost, now_ns, [&](std::int64_t late_ns) {
    const InFlight at{.packet = KeptPacket<255>::of(answer_), .robot = robot, .arrives_ns = now_ns + late_ns};
    if (!late_listed_.push(at, at.arrives_ns)) crowded_out(AirWay::kToHost);
  });
}

PacketError PlainLink::send_back(int robot, std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  const std::int64_t at_ns = std::max(now_ns + plain_.to_host_ns, next_answer_ns_);
  PacketError error = PacketError::kNone;
  const auto arrive_at_host = [&](std::int64_t late_ns) {
    const InFlight at{.packet = KeptPacket<255>::of(frame), .robot = robot, .arrives_ns = at_ns + late_ns};
    if (!answers_.push(at, at.arrives_ns)) {
      error = PacketError::kOverrun;
      return;
    }
    next_answer_ns_ = at_ns + plain_.answer_gap_ns;
  };
  robot < 0 ? arrive_at_host(0) : through_air(robot, AirWay::kToHost, at_ns, arrive_at_host);
  return error;
}

}  // namespace

std::unique_ptr<RadioLink> make_plain_dongle(const RadioFormat& format, const RadioLinkConfig& config,
                                             const PlainDongle& plain) {
  return std::make_unique<PlainLink>(format, config, plain);
}

}  // namespace omnihil
