// What a host writes to a dongle, however it is cut, and what robots' firmware sends: of every radio format.
//
// Byte 0 picks the format, byte 1 (bit 0) whether firmware decodes; then chunks: one byte what happens (low 2 bits: the
// host writes, the host leaves, a robot sends, state of the robots) and how long (upper 6 bits), then its bytes.
#include <cmath>
#include <memory>
#include <vector>

#include "protocols/radio_format.h"
#include "protocols/radio_link.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

constexpr std::int64_t kStep_ns = 1'000'000;

class Robots final : public RadioSink {
 public:
  void deliver(const Delivery& d, std::int64_t) override {
    demand(d.robot_id == 0 || d.robot_id == 1 || d.robot_id == 5, "a robot that is there");
    if (d.kind != Delivery::Kind::kCommand) return;
    const RobotCommand& c = d.command;
    demand(std::isfinite(c.v_forward_m_s) && std::isfinite(c.v_left_m_s) && std::isfinite(c.omega_body_rad_s),
           "a command of finite velocities");
    for (int w = 0; w < kWheels; ++w) {
      demand(std::isfinite(c.omega_wheel_rad_s[w]) && std::isfinite(c.duty_ratio[w]), "of finite wheels");
    }
    demand(std::isfinite(c.v_kick_m_s) && std::isfinite(c.kick_pulse_s) && std::isfinite(c.dribbler_ratio),
           "and a finite kick");
  }
};

void drive(const RadioFormat& format, bool firmware_decodes, std::span<const std::uint8_t> bytes) {
  RadioLinkConfig config;
  config.robot_ids = format.names_robots() ? std::vector<int>{0, 1, 5} : std::vector<int>{5};
  config.firmware_decodes = firmware_decodes;
  config.wheel_radius_m = 0.027;
  const auto link = format.make_link(config);
  Robots robots;
  std::vector<std::uint8_t> out;
  std::int64_t now_ns = 0;
  while (!bytes.empty()) {
    const std::uint8_t what = take_byte(bytes);
    const auto chunk = take_bytes(bytes, what >> 2U);
    switch (what & 3U) {
      case 0:
        link->host_bytes(chunk, now_ns);
        break;
      case 1:
        if (chunk.empty()) link->host_closed(now_ns);
        break;
      case 2:
        link->robot_frame(5, chunk, now_ns);
        break;
      default:
        link->robot_feedback(5, RobotFeedback{}, RobotGains{}, now_ns);
    }
    link->poll(now_ns, robots);
    out.clear();
    link->take_host_bytes(now_ns, out);
    now_ns += kStep_ns;
  }
}

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const auto formats = radio_formats();
  const RadioFormat& format = *formats[take_byte(bytes) % formats.size()];
  const bool firmware_decodes = (take_byte(bytes) & 1U) != 0;
  if (format.has_dongle()) drive(format, firmware_decodes, bytes);
}
