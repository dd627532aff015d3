#include "protocols/dongles/rnp_link.h"

#include <optional>

#include "protocols/dongles/air_queue.h"
#include "protocols/dongles/dongle.h"
#include "protocols/dongles/kept_packet.h"
#include "protocols/dongles/ring.h"

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kHelloPeriod_ns = 1'000 * kMs;
constexpr std::int64_t kTelemetryPeriod_ns = 10 * kMs;  // the robot's radio loop
constexpr std::int64_t kControlTimeout_ns = 200 * kMs;  // 20 ticks of its control
constexpr std::int64_t kHostTimeout_ns = 1'000 * kMs;
constexpr std::int64_t kAir_ns = 1 * kMs;         // choice: one way over Wi-Fi
constexpr std::int64_t kHalfPacket_ns = 5 * kMs;  // choice: a datagram that was no packet is over by then
constexpr std::size_t kHostBuffer = 16'384, kInFlight = 64,
                      kLongest = 320;  // the formats' longest: 308 bytes

struct InFlight {
  KeptPacket<255> packet;
  std::int64_t arrives_ns = 0;
};

class RnpLink final : public Dongle {
 public:
  RnpLink(const RadioFormat& format, const RadioLinkConfig& config, const RnpDialect& dialect)
      : Dongle(format, config, kHostBuffer),
        dialect_(dialect),
        stream_(dialect.frame_bytes, from_host_),
        late_to_robot_(air_room()),
        late_to_host_(air_room()) {}

  void host_bytes(std::span<const std::uint8_t> bytes, std::int64_t now_ns) override {
    if (now_ns - last_byte_ns_ > kHalfPacket_ns) stream_.close();
    last_byte_ns_ = now_ns;
    stream_.feed(bytes,
                 [&](std::span<const std::uint8_t> packet) { from_host_.count(accept(packet, now_ns)); });
  }

  void poll(std::int64_t now_ns, RadioSink& sink) override {
    for (; !to_robot_.empty() && to_robot_.front().arrives_ns <= now_ns; to_robot_.pop()) {
      cross(to_robot_.front(), sink);
    }
    arrive(now_ns, sink);
    if (connected_ && now_ns - heard_ns_ > kHostTimeout_ns) leave(now_ns, sink);
    if (control_ && now_ns - control_ns_ > kControlTimeout_ns) stop(now_ns, sink);
  }

  void robot_frame(int robot_id, std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    PacketError error = fault_from_robot(frame);
    if (error == PacketError::kNone && robot_id != id()) error = PacketError::kAddress;
    if (error == PacketError::kNone && frame.size() > kLongest) error = PacketError::kTooLong;
    if (error != PacketError::kNone) return from_robots_.count(error);
    cross_back(frame, now_ns);
  }

  void take_host_bytes(std::int64_t now_ns, std::vector<std::uint8_t>& out) override {
    arrive_back(now_ns);
    Dongle::take_host_bytes(now_ns, out);
  }

  void robot_feedback(int robot_id, const RobotFeedback& feedback, const RobotGains& gains,
                      std::int64_t now_ns) override {
    if (robot_id != id() || config_.firmware_decodes) return;
    gains_ = gains;
    if (connected_ && now_ns >= next_telemetry_ns_) {
      Values out;
      dialect_.telemetry(feedback, control_ ? &*control_ : nullptr, sequence_++, out);
      say(out, now_ns);
      next_telemetry_ns_ = now_ns + kTelemetryPeriod_ns;
    } else if (!connected_ && now_ns >= next_hello_ns_) {
      Values out;
      dialect_.hello(id(), config_.team, out);
      say(out, now_ns);
      next_hello_ns_ = now_ns + kHelloPeriod_ns;
    }
  }

  void host_closed(std::int64_t now_ns) override {
    stream_.close();
    Dongle::host_closed(now_ns);
  }

 private:
  int id() const { return config_.robot_ids.size() == 1 ? config_.robot_ids.front() : -1; }

  PacketError accept(std::span<const std::uint8_t> packet, std::int64_t now_ns) {
    const DecodeResult result = format_.decode(packet);
    if (result.error != PacketError::kNone) return result.error;
    if (never_from_host(*result.values.message)) return PacketError::kDirection;
    if (id() < 0) return PacketError::kAddress;
    if (packet.size() > 255) return PacketError::kTooLong;
    const bool room = to_robot_.push({.packet = KeptPacket<255>::of(packet), .arrives_ns = now_ns + kAir_ns});
    return room ? PacketError::kNone : PacketError::kOverrun;
  }

  void cross(const InFlight& at, RadioSink& sink) {
    through_air(id(), AirWay::kToRobot, at.arrives_ns, [&](std::int64_t late_ns) {
      if (config_.air == nullptr) return receive(at, sink);
      InFlight copy = at;
      copy.arrives_ns += late_ns;
      if (!late_to_robot_.push(copy, copy.arrives_ns)) crowded_out(AirWay::kToRobot);
    });
    arrive(at.arrives_ns, sink);
  }

  void arrive(std::int64_t now_ns, RadioSink& sink) {
    for (; const InFlight* at = late_to_robot_.due(now_ns); late_to_robot_.pop()) receive(*at, sink);
  }

  void say(const Values& values, std::int64_t now_ns) {
    said_.clear();
    encode(values, said_);
    cross_back(said_, now_ns);
  }

  void cross_back(std::span<const std::uint8_t> packet, std::int64_t now_ns) {
    through_air(id(), AirWay::kToHost, now_ns, [&](std::int64_t late_ns) {
      if (config_.air == nullptr) return from_robots_.count(to_host(packet));
      if (!late_to_host_.push(KeptPacket<kLongest>::of(packet), now_ns + late_ns))
        crowded_out(AirWay::kToHost);
    });
  }

  void arrive_back(std::int64_t now_ns) {
    for (; auto* packet = late_to_host_.due(now_ns); late_to_host_.pop()) {
      if (survives(id(), AirWay::kToHost, packet->span())) from_robots_.count(to_host(packet->span()));
    }
  }

  void receive(InFlight at, RadioSink& sink) {
    const Message* sent = format_.decode(at.packet.span()).values.message;
    if (!survives(id(), AirWay::kToRobot, at.packet.span())) return;
    if (config_.firmware_decodes) {
      return deliver_frame(sink, id(), *sent, at.packet.span(), at.arrives_ns);
    }
    const Values values = format_.decode(at.packet.span()).values;
    heard_ns_ = at.arrives_ns;
    const std::uint32_t type = values.message->type;
    if (type == dialect_.hello_answer) {
      if (!connected_) next_telemetry_ns_ = at.arrives_ns;
      connected_ = true;
    } else if (!connected_) {
      return;
    } else if (dialect_.turns_away(values)) {
      leave(at.arrives_ns, sink);
    } else if ((type & 0xFFu) == dialect_.control) {  // higher bits: a mode of it
      control_ = values;
      control_ns_ = at.arrives_ns;
      deliver(sink, dialect_.to_command(values), values.message->name, at.arrives_ns);
    } else if (type == dialect_.parameters && dialect_.parameter != nullptr) {
      answer_parameter(values, sink, at.arrives_ns);
    }
  }

  void answer_parameter(const Values& asked, RadioSink& sink, std::int64_t at_ns) {
    Values out;
    if (dialect_.parameter(asked, gains_, out)) {
      Delivery delivery;
      delivery.kind = Delivery::Kind::kGains;
      delivery.robot_id = id();
      delivery.gains = gains_;
      delivery.message = asked.message->name;
      sink.deliver(delivery, at_ns);
    }
    say(out, at_ns);
  }

  void deliver(RadioSink& sink, const RobotCommand& command, std::string_view message, std::int64_t at_ns) {
    Delivery delivery;
    delivery.robot_id = id();
    delivery.command = command;
    delivery.message = message;
    sink.deliver(delivery, at_ns);
  }

  // Velocity 0: the wheels stop, the controllers stay on.
  void stop(std::int64_t now_ns, RadioSink& sink) {
    RobotCommand still{};
    still.mode = OMNIHIL_MODE_BODY_VELOCITY;
    deliver(sink, still, control_->message->name, now_ns);
    control_.reset();
  }

  // The robot starts anew, without a host; its wheels run free meanwhile.
  void leave(std::int64_t now_ns, RadioSink& sink) {
    deliver(sink, RobotCommand{}, "", now_ns);
    control_.reset();
    connected_ = false;
    next_hello_ns_ = now_ns;
  }

  const RnpDialect dialect_;
  SizedStream stream_;
  std::int64_t last_byte_ns_ = 0;
  Ring<InFlight, kInFlight> to_robot_;
  AirQueue<InFlight> late_to_robot_;  // as the air brings them
  AirQueue<KeptPacket<kLongest>> late_to_host_;
  std::vector<std::uint8_t> said_;
  bool connected_ = false;
  std::optional<Values> control_;
  RobotGains gains_{};
  std::int64_t control_ns_ = 0, heard_ns_ = 0, next_hello_ns_ = 0, next_telemetry_ns_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace

std::unique_ptr<RadioLink> make_rnp_link(const RadioFormat& format, const RadioLinkConfig& config,
                                         const RnpDialect& dialect) {
  return std::make_unique<RnpLink>(format, config, dialect);
}

}  // namespace omnihil
