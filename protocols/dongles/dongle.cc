#include "protocols/dongles/dongle.h"

#include <cassert>

namespace omnihil {

Address address_of(const Values& values) {
  const auto is_set = [&](FieldRole role) { return values.number_or(role, 0.0) != 0.0; };
  Address address{.robot = static_cast<int>(values.number_or(FieldRole::kRobot, -1.0)),
                  .team = std::nullopt,
                  .all_robots = is_set(FieldRole::kAllRobots),
                  .dongle = is_set(FieldRole::kForDongle),
                  .host = is_set(FieldRole::kForHost)};
  if (values.message->field_index(FieldRole::kTeam) >= 0) {
    address.team = is_set(FieldRole::kTeam) ? Team::kBlue : Team::kYellow;
  }
  if (values.message->field_index(FieldRole::kTeamYellow) >= 0) {
    address.team = is_set(FieldRole::kTeamYellow) ? Team::kYellow : Team::kBlue;
  }
  return address;
}

bool never_from_host(const Message& message) {
  return message.direction == Direction::kFromRobot || message.direction == Direction::kFromDongle ||
         message.direction == Direction::kInside;
}

Dongle::Dongle(const RadioFormat& format, const RadioLinkConfig& config, std::size_t host_buffer_bytes)
    : format_(format), config_(config), host_buffer_bytes_(host_buffer_bytes) {
  host_out_.reserve(host_buffer_bytes_);
  encoded_.reserve(static_cast<std::size_t>(format.max_frame_bytes));
}

void Dongle::take_host_bytes(std::int64_t, std::vector<std::uint8_t>& out) {
  out.insert(out.end(), host_out_.begin(), host_out_.end());
  host_out_.clear();
}

void Dongle::host_closed(std::int64_t) { host_out_.clear(); }

PacketError Dongle::fault_from_robot(std::span<const std::uint8_t> frame) const {
  const DecodeResult result = format_.decode(frame);
  if (result.error != PacketError::kNone) return result.error;
  const Direction direction = result.values.message->direction;
  return direction == Direction::kToRobot || direction == Direction::kInside ? PacketError::kDirection
                                                                             : PacketError::kNone;
}

PacketError Dongle::fault_to_robot(int robot, std::span<const std::uint8_t> packet) const {
  const DecodeResult result = format_.decode(packet);
  if (result.error != PacketError::kNone) return result.error;
  if (never_from_host(*result.values.message) || result.values.message->direction == Direction::kToDongle)
    return PacketError::kDirection;
  const Address address = address_of(result.values);
  const bool meant = address.all_robots || address.robot < 0 || address.robot == robot;
  return meant && address.team.value_or(config_.team) == config_.team ? PacketError::kNone
                                                                      : PacketError::kAddress;
}

bool Dongle::survives(int robot, AirWay way, std::span<std::uint8_t> packet) {
  if (config_.air == nullptr || !config_.air->flip(packet)) return true;
  const bool up = way == AirWay::kToHost;
  const PacketError error = up ? fault_from_robot(packet) : fault_to_robot(robot, packet);
  config_.air->judged(way, error == PacketError::kNone ? AirVerdict::kSlipped : AirVerdict::kRefused);
  if (error == PacketError::kNone) return true;
  if (up) from_robots_.count(error);
  return !up && config_.firmware_decodes;
}

void Dongle::deliver_frame(RadioSink& sink, int robot, const Message& message,
                           std::span<const std::uint8_t> frame, std::int64_t at_ns) {
  Delivery delivery;
  delivery.kind = Delivery::Kind::kFrame;
  delivery.robot_id = robot;
  delivery.frame = frame;
  delivery.message = message.name;
  sink.deliver(delivery, at_ns);
}

PacketError Dongle::to_host(std::span<const std::uint8_t> bytes) {
  if (host_out_.size() + bytes.size() > host_buffer_bytes_) return PacketError::kOverrun;
  host_out_.insert(host_out_.end(), bytes.begin(), bytes.end());
  return PacketError::kNone;
}

PacketError Dongle::to_host(const Values& values) {
  encoded_.clear();
  encode(values, encoded_);
  return to_host(encoded_);
}

void Dongle::encode(const Values& values, std::vector<std::uint8_t>& out) const {
  const RadioFormat::EncodeResult result = format_.encode(values, out);
  assert(result.error == PacketError::kNone);
  static_cast<void>(result);
}

}  // namespace omnihil
