#include "protocols/dongles/plain_dongle.h"

#include <optional>

#include "protocols/dongles/dongle.h"
#include "protocols/dongles/kept_packet.h"
#include "protocols/dongles/ring.h"
#include "protocols/dongles/robot_table.h"

namespace omnihil {
namespace {

constexpr std::size_t kHostBuffer = 16384;  // choice: ULaval's stick keeps as much
constexpr std::size_t kInFlight = 128;      // choice: 16 robots, eight frames each

struct InFlight {
  KeptPacket<255> packet;
  int robot = 0;
  std::int64_t arrives_ns = 0;
};

struct Robot {
  std::optional<RobotFeedback> feedback;  // none: it is still starting, and silent
};

class PlainLink final : public Dongle {
 public:
  PlainLink(const RadioFormat& format, const RadioLinkConfig& config, const PlainDongle& plain)
      : Dongle(format, config, kHostBuffer),
        plain_(plain),
        stream_(plain.frame_bytes, from_host_),
        robots_(config.robot_ids) {
    answer_.reserve(static_cast<std::size_t>(format.max_frame_bytes));
  }

  void host_bytes(std::span<const std::uint8_t> bytes, std::int64_t now_ns) override {
    stream_.feed(bytes,
                 [&](std::span<const std::uint8_t> frame) { from_host_.count(accept(frame, now_ns)); });
  }

  void poll(std::int64_t now_ns, RadioSink& sink) override {
    while (!to_robots_.empty() && to_robots_.front().arrives_ns <= now_ns) {
      reach_robot(to_robots_.front(), sink);
      to_robots_.pop();
    }
  }

  void robot_frame(int robot_id, std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    PacketError error = fault_from_robot(frame);
    if (error == PacketError::kNone && robots_.find(robot_id) == nullptr) error = PacketError::kAddress;
    if (error == PacketError::kNone) error = send_back(robot_id, frame, now_ns);
    if (error != PacketError::kNone) from_robots_.count(error);
  }

  void robot_feedback(int robot_id, const RobotFeedback& feedback, const RobotGains&, std::int64_t) override {
    if (Robot* robot = robots_.find(robot_id)) robot->feedback = feedback;
  }

  void take_host_bytes(std::int64_t now_ns, std::vector<std::uint8_t>& out) override {
    while (!answers_.empty() && answers_.front().arrives_ns <= now_ns) {
      from_robots_.count(to_host(answers_.front().packet.span()));
      answers_.pop();
    }
    Dongle::take_host_bytes(now_ns, out);
  }

  void host_closed(std::int64_t now_ns) override {
    stream_.close();
    Dongle::host_closed(now_ns);
  }

 private:
  PacketError accept(std::span<const std::uint8_t> frame, std::int64_t now_ns);
  PacketError send_back(int robot, std::span<const std::uint8_t> frame, std::int64_t now_ns);
  void reach_robot(const InFlight& at, RadioSink& sink);

  PlainDongle plain_;
  SizedStream stream_;
  RobotTable<Robot, 256> robots_;
  Ring<InFlight, kInFlight> to_robots_;
  Ring<InFlight, kInFlight> answers_;
  std::vector<std::uint8_t> answer_;
};

PacketError PlainLink::accept(std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  const DecodeResult result = format_.decode(frame);
  if (result.error != PacketError::kNone) return result.error;
  if (never_from_host(*result.values.message)) return PacketError::kDirection;
  const Address address = address_of(result.values);
  if (address.team.value_or(config_.team) != config_.team) return PacketError::kAddress;
  return for_addressed(address, [&](int id) {
    if (robots_.find(id) == nullptr) return PacketError::kAddress;
    const bool room = to_robots_.push(
        {.packet = KeptPacket<255>::of(frame), .robot = id, .arrives_ns = now_ns + plain_.to_robot_ns});
    return room ? PacketError::kNone : PacketError::kOverrun;
  });
}

void PlainLink::reach_robot(const InFlight& at, RadioSink& sink) {
  const Values values = format_.decode(at.packet.span()).values;
  if (config_.firmware_decodes) {
    return deliver_frame(sink, at.robot, *values.message, at.packet.span(), at.arrives_ns);
  }
  const MessageRole role = values.message->role;
  const bool drives = role == MessageRole::kCommand || role == MessageRole::kSingleCommand;
  if (drives || role == MessageRole::kKill) {
    Delivery delivery;
    delivery.robot_id = at.robot;
    delivery.message = values.message->name;
    if (drives) delivery.command = plain_.to_command(values);
    sink.deliver(delivery, at.arrives_ns);
  }
  const std::optional<RobotFeedback>& feedback = robots_.find(at.robot)->feedback;
  Values out;
  if (plain_.answer == nullptr || !feedback || !plain_.answer(values, at.robot, *feedback, out)) return;
  answer_.clear();
  encode(out, answer_);
  const PacketError error = send_back(at.robot, answer_, at.arrives_ns);
  if (error != PacketError::kNone) from_robots_.count(error);
}

PacketError PlainLink::send_back(int robot, std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  const bool room = answers_.push(
      {.packet = KeptPacket<255>::of(frame), .robot = robot, .arrives_ns = now_ns + plain_.to_host_ns});
  return room ? PacketError::kNone : PacketError::kOverrun;
}

}  // namespace

std::unique_ptr<RadioLink> make_plain_dongle(const RadioFormat& format, const RadioLinkConfig& config,
                                             const PlainDongle& plain) {
  return std::make_unique<PlainLink>(format, config, plain);
}

}  // namespace omnihil
