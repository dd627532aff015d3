// One robot behind a dongle, driven for two seconds by a command every 20 ms: what of it reached whom, and when.
//
//   const Passed without = drive_link(format, nullptr);
#pragma once
#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil {

struct DriveSink : RadioSink {
  void deliver(const Delivery& delivery, std::int64_t at_ns) override {
    if (delivery.command.v_forward_m_s == 0.0) return;
    if (drives++ == 0) first_ns = at_ns;
    last_ns = at_ns;
  }
  int drives = 0;
  std::int64_t first_ns = 0, last_ns = 0;
};

struct Passed {
  int drives = 0;                          // commands that drive and reached a robot
  std::int64_t first_ns = 0, last_ns = 0;  // when
  std::uint64_t from_host = 0;             // packets, as the dongle saw them
  std::uint64_t from_robots = 0, refused = 0;
  std::int64_t first_answer_ns = -1;
};

inline bool has_velocity(const RadioFormat& format) {
  return format.encode_command != nullptr && format.can_drive(OMNIHIL_MODE_BODY_VELOCITY);
}

// 0.5 m/s ahead, as this format says it: some know no frame but the field's, some no turn but to a yaw.
inline void encode_ahead(const RadioFormat& format, const CommandTo& to, std::vector<std::uint8_t>& packet) {
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = 0.5;
  constexpr std::uint32_t kField = OMNIHIL_COMMAND_FIELD_FRAME, kYaw = OMNIHIL_COMMAND_YAW_TARGET;
  for (const std::uint32_t flags : {0U, kField, kField | kYaw}) {
    command.flags = flags;
    if (format.encode_command(command, to, packet)) return;
  }
  ADD_FAILURE() << format.id;
}

inline Passed drive_link(const RadioFormat& format, RadioAir* air) {
  RadioLinkConfig config;
  config.robot_ids = {1};
  config.air = air;
  config.wheel_radius_m = 0.027;
  const auto link = format.make_link(config);
  DriveSink sink;
  std::vector<std::uint8_t> packet, out;
  Passed passed;
  for (std::int64_t n = 0; n < 2'000; ++n) {
    const std::int64_t now_ns = n * 1'000'000;
    packet.clear();
    if (n % 20 == 0) encode_ahead(format, {.robot_id = 1, .team = config.team, .set_up = n == 0}, packet);
    if (!packet.empty()) link->host_bytes(packet, now_ns);
    link->poll(now_ns, sink);
    link->robot_feedback(1, RobotFeedback{}, RobotGains{}, now_ns);
    link->take_host_bytes(now_ns, out);
    if (passed.first_answer_ns < 0 && link->from_robots().good > 0) passed.first_answer_ns = now_ns;
  }
  passed.drives = sink.drives;
  passed.first_ns = sink.first_ns;
  passed.last_ns = sink.last_ns;
  passed.from_host = link->from_host().good;
  passed.from_robots = link->from_robots().good;
  passed.refused = link->from_robots().refused();
  return passed;
}

inline std::string format_name(const testing::TestParamInfo<const RadioFormat*>& param) {
  std::string name(param.param->id);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

}  // namespace omnihil
