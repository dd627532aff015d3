#include "hil/loop/radio_front.h"

#include <cmath>

#include "protocols/meaning.h"
#include "protocols/telemetry.h"

namespace omnihil {
namespace {

// Of the dongle's clock. Frames of one command are on the air one after the other, at 60 Hz at the slowest (REM): 40 ms hold
// two such turns. Choices.
constexpr std::int64_t kStep_ns = 1'000'000;
constexpr int kQuiet = 5, kPatience = 40;
constexpr Team kTeam = Team::kBlue;  // what serve takes where nobody says another

struct Frames : RadioSink {
  Frames(Firmware& to, std::int64_t at_ns) : firmware(to), now_ns(at_ns) {}
  void deliver(const Delivery& delivery, std::int64_t) override {
    if (delivery.kind == Delivery::Kind::kFrame) firmware.radio_receive(delivery.frame, now_ns);
    if (delivery.kind == Delivery::Kind::kCommand) firmware.command(delivery.command, now_ns);
    ++count;
  }
  Firmware& firmware;
  std::int64_t now_ns;
  int count = 0;
};

}  // namespace

RadioFront::RadioFront(const RadioFormat& format, int robot_id, double wheel_radius_m)
    : format_(format), robot_id_(robot_id), tells_speeds_(tells_wheel_speeds(format)) {
  RadioLinkConfig config;
  config.robot_ids = {robot_id};
  config.team = kTeam;
  config.firmware_decodes = true;
  config.wheel_radius_m = wheel_radius_m;
  link_ = format.make_link(config);
}

bool RadioFront::say(const RobotCommand& command, Firmware& firmware, std::int64_t now_ns, double yaw_rad) {
  bytes_.clear();
  const CommandTo to{.robot_id = robot_id_, .team = kTeam, .set_up = set_up_, .tell_all = tells_speeds_};
  if (!encode_towards(format_, command, yaw_rad, to, bytes_)) return false;
  Frames frames(firmware, now_ns);
  link_->host_bytes(bytes_, clock_ns_);
  // Until nothing has come for a while; what has to go first may come by itself.
  const int patience = set_up_ ? 2 * kPatience : kPatience;
  for (int step = 0, quiet = 0; step < patience && (set_up_ || quiet < kQuiet); ++step) {
    const int before = frames.count;
    clock_ns_ += kStep_ns;
    link_->poll(clock_ns_, frames);
    quiet = frames.count > before || frames.count == 0 ? 0 : quiet + 1;
  }
  set_up_ = false;
  bytes_.clear();
  link_->take_host_bytes(clock_ns_, bytes_);  // of the dongle itself: nobody reads them
  return true;
}

std::optional<RobotCommand> encode_towards(const RadioFormat& format, const RobotCommand& command,
                                           double yaw_rad, const CommandTo& to,
                                           std::vector<std::uint8_t>& out) {
  if (encode_drive(format, command, to, out)) return command;
  if (command.mode != OMNIHIL_MODE_BODY_VELOCITY || !std::isfinite(yaw_rad)) return std::nullopt;
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  RobotCommand in_field = command;
  in_field.v_forward_m_s = c * command.v_forward_m_s - s * command.v_left_m_s;
  in_field.v_left_m_s = s * command.v_forward_m_s + c * command.v_left_m_s;
  in_field.flags |= OMNIHIL_COMMAND_FIELD_FRAME;
  return encode_drive(format, in_field, to, out) ? std::optional(in_field) : std::nullopt;
}

bool can_say(const RadioFormat& format, const RobotCommand& command) {
  std::vector<std::uint8_t> bytes;
  return encode_towards(format, command, 0.0, {}, bytes).has_value();
}

}  // namespace omnihil
