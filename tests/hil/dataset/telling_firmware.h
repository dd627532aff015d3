// A firmware that drives as another does, and tells its wheel speeds by a radio format of its own, as an image on a board would:
// what is told is known in closed form.
//
//   auto boards = std::make_unique<TellingFirmware>(std::move(other), Telling{.every = 10, .filter_s = 0.02}, config);
//   BootedImage image(std::move(boards), &telling_format(), config, 0.05);
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "firmware_iface/ports.h"
#include "hil/radio_file/radio_file.h"
#include "protocols/meaning.h"

namespace omnihil {

inline constexpr double kToldStep_rad_s = 0.02;
inline constexpr std::int64_t kToHost_ns = 2'000'000;

inline const RadioFormat& telling_format() {
  static const RadioFormat* const format = [] {
    std::string text = R"(format = "omnihil-radio/1"
id = "telling"
title = "tells its wheels"
framing = "none"
[carrier]
kind = "uart"
baud = 1000000
[air]
to_robot_us = 100
to_host_us = 2000
[[packet]]
name = "GO"
type = 1
direction = "to robot"
bit_order = "lsb first"
role = "command"
asks = "body velocity"
fields = [
  { name = "kind", bits = 8, kind = "type", envelope = true },
  { name = "robot", bits = 8, kind = "integer", role = "robot" },
  { name = "x", bits = 32, kind = "float32", means = "v_forward_m_s" },
  { name = "y", bits = 32, kind = "float32", means = "v_left_m_s" },
  { name = "w", bits = 32, kind = "float32", means = "omega_body_rad_s" },
]
[[packet]]
name = "STATE"
type = 2
direction = "from robot"
bit_order = "lsb first"
role = "feedback"
fields = [
  { name = "kind", bits = 8, kind = "type", envelope = true },
  { name = "robot", bits = 8, kind = "integer", role = "robot" },
)";
    for (const char w : std::string("0123"))
      text += std::string("  { name = \"wheel") + w +
              "\", bits = 16, kind = \"integer\", sign = \"twos-complement\", means = \"omega_wheel_rad_s[" +
              w + "]\", times = 0.02 },\n";
    const RadioFile file = read_radio_file(text + "]\n", "telling.toml");
    for (const ModelProblem& p : file.problems) ADD_FAILURE() << p.key << " " << p.what << " " << p.allowed;
    return file.format;
  }();
  return *format;
}

// By counts: the mean speed since the packet before. Else the shafts' speeds, low-passed tick by tick.
struct Telling {
  int every = 10;         // ticks; 0: it tells nothing
  double filter_s = 0.0;  // 0: none
  bool counted = true;
};

class TellingFirmware final : public Firmware {
 public:
  // `drives` null: nobody does.
  TellingFirmware(std::unique_ptr<Firmware> drives, const Telling& how, const RobotConfig& config)
      : drives_(std::move(drives)), how_(how), config_(config) {}

  std::string_view name() const override { return "telling"; }
  std::string_view radio_format() const override { return telling_format().id; }
  std::int64_t control_period_ns() const override {
    return drives_ ? drives_->control_period_ns() : 1'000'000;
  }
  void command(const RobotCommand& c, std::int64_t now_ns) override {
    if (drives_) drives_->command(c, now_ns);
  }
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    command(command_by_meaning(telling_format().decode(frame).values), now_ns);
  }
  std::size_t radio_transmit(std::span<std::uint8_t> out) override {
    if (waiting_.empty()) return 0;
    const std::vector<std::uint8_t> frame = waiting_.front();
    waiting_.pop_front();
    std::ranges::copy(frame, out.begin());
    return frame.size();
  }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  void shafts(const RobotShafts& exact) override { exact_ = exact; }
  RobotDrive tick(const RobotSensors& sensors) override {
    const double dt_s = 1e-9 * static_cast<double>(control_period_ns());
    const double share = how_.filter_s > 0.0 && ticks_ > 0 ? -std::expm1(-dt_s / how_.filter_s) : 1.0;
    for (std::size_t w = 0; w < kWheels; ++w)
      smooth_[w] += (exact_.omega_rotor_rad_s[w] - smooth_[w]) * share;
    ++ticks_;
    if (how_.every > 0 && ticks_ % how_.every == 0) say_speeds(sensors, how_.every * dt_s);
    return drives_ ? drives_->tick(sensors) : RobotDrive{};
  }
  RobotFeedback feedback() const override { return {}; }

 private:
  void say_speeds(const RobotSensors& sensors, double span_s) {
    const double rad_per_count = 2.0 * std::numbers::pi / config_.encoder_counts_per_rotor_turn;
    Values v;
    v.message = telling_format().find("STATE");
    v.set("robot", static_cast<double>(config_.robot_id));
    for (std::size_t w = 0; w < kWheels; ++w) {
      const double turned = static_cast<double>(sensors.encoder_counts[w] - last_counts_[w]) * rad_per_count;
      const double rotor_rad_s = how_.counted ? turned / span_s : smooth_[w];
      v.set("wheel" + std::to_string(w), std::round(rotor_rad_s / config_.gear_ratio / kToldStep_rad_s));
      last_counts_[w] = sensors.encoder_counts[w];
    }
    std::vector<std::uint8_t> frame;
    EXPECT_EQ(telling_format().encode(v, frame).error, PacketError::kNone);
    waiting_.push_back(frame);
  }

  std::unique_ptr<Firmware> drives_;
  Telling how_;
  RobotConfig config_;
  RobotShafts exact_{};
  std::array<double, kWheels> smooth_{};
  std::array<std::int64_t, kWheels> last_counts_{};
  std::deque<std::vector<std::uint8_t>> waiting_;
  int ticks_ = 0;
};

}  // namespace omnihil
