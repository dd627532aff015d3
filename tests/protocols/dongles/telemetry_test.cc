// What a robot's packets tell in SI is what the robot had, through each format's own dongle.
#include "protocols/telemetry.h"

#include <cmath>

#include "protocols/codec.h"
#include "protocols/meaning.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

constexpr int kRobot = 5;

RobotFeedback known() {
  RobotFeedback f{};
  f.battery_V = 22.4F;
  f.yaw_rad = 0.7F;
  f.omega_body_rad_s = 1.5F;
  for (int w = 0; w < kWheels; ++w) f.omega_wheel_rad_s[w] = 10.0F * static_cast<float>(w) - 12.0F;
  return f;
}

// Everything that comes back in 200 ms of commands that ask for all there is.
TelemetryReading told(const RadioFormat& format) {
  Bench bench(format, {.robot_ids = {kRobot}, .team = Team::kYellow});
  bench.robots[kRobot] = known();
  RobotCommand still{};
  still.mode = OMNIHIL_MODE_BODY_VELOCITY;
  Bytes bytes;
  for (const std::uint32_t flags :
       {std::uint32_t{0}, std::uint32_t{OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET}}) {
    still.flags = flags;
    bytes.clear();
    if (encode_drive(format, still, {.robot_id = kRobot, .tell_all = true}, bytes)) break;
  }
  EXPECT_FALSE(bytes.empty()) << format.id;
  for (int n = 0; n < 10; ++n) {
    bench.write(bytes);
    bench.run_to(bench.now_ns + 20 * kMs);
  }
  TelemetryReading all;
  const auto take = [](double& into, double from) {
    if (std::isfinite(from)) into = from;
  };
  for (const DecodeResult& answer : bench.answers()) {
    const auto one = telemetry_of(format, answer.values);
    if (!one) continue;
    all.robot_id = std::max(all.robot_id, one->robot_id);
    for (std::size_t w = 0; w < kWheels; ++w) take(all.omega_wheel_rad_s[w], one->omega_wheel_rad_s[w]);
    take(all.battery_V, one->battery_V);
    take(all.yaw_rad, one->yaw_rad);
    take(all.omega_body_rad_s, one->omega_body_rad_s);
  }
  return all;
}

TEST(Telemetry, WhatIsToldIsWhatTheRobotHad) {
  int wheels = 0, batteries = 0;
  for (const RadioFormat* format : radio_formats()) {
    if (!tells_anything(*format) || format->id.starts_with("ateam"))
      continue;  // A-Team's wants a handshake first
    const RobotFeedback f = known();
    const TelemetryReading t = told(*format);
    if (format->names_robots() && t.robot_id >= 0) {
      EXPECT_EQ(t.robot_id, kRobot) << format->id;
    }
    const bool v5 = format->id == "roboteam-rem-v5";  // whole volts
    if (std::isfinite(t.battery_V)) {
      ++batteries;
      EXPECT_NEAR(t.battery_V, f.battery_V, v5 ? 1.0 : 0.11) << format->id;
    }
    if (std::isfinite(t.yaw_rad)) {
      EXPECT_NEAR(t.yaw_rad, f.yaw_rad, 0.012) << format->id;
    }
    if (std::isfinite(t.omega_body_rad_s)) {
      EXPECT_NEAR(t.omega_body_rad_s, f.omega_body_rad_s, 0.002) << format->id;
    }
    EXPECT_EQ(std::isfinite(t.omega_wheel_rad_s[0]), tells_wheel_speeds(*format)) << format->id;
    if (!tells_wheel_speeds(*format)) continue;
    ++wheels;
    const double step = std::max(wheel_speed_step_rad_s(*format), 1e-5);  // a float32 has none
    for (std::size_t w = 0; w < kWheels; ++w)
      EXPECT_NEAR(t.omega_wheel_rad_s[w], f.omega_wheel_rad_s[w], 1.01 * step) << format->id;
  }
  EXPECT_GE(wheels, 4);  // REM v5 and v8, ibis twice
  EXPECT_GE(batteries, 8);
}

TEST(Telemetry, APacketToARobotTellsNothing) {
  const RadioFormat& format = *find_radio_format("roboteam-rem-v8");
  Values values;
  values.message = format.find("REM_RobotCommand");
  EXPECT_FALSE(telemetry_of(format, values));
  values.message = format.find("REM_Log");
  EXPECT_FALSE(telemetry_of(format, values));
}

}  // namespace
}  // namespace omnihil
