// What every emulated reference image is asked: the shipped scenarios, broken images that fail their check
// alone, one hash for two runs.
//
//   expect_only_its_check_fails(options, broken);      // {"sign_error", "direction", "commanded_sign"}
#pragma once
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "hil/recording/replay_hash.h"
#include "hil/scenario/scenario_suite.h"
#include "protocols/radio_format.h"

namespace omnihil {

inline const std::string kSuite = OMNIHIL_SOURCE_DIR "/examples/scenarios";

inline Scenario shipped_scenario(const std::string& name) {
  SuiteReading suite = read_suite({kSuite + "/" + name}, "");
  EXPECT_EQ(suite.problems, std::vector<std::string>{});
  return suite.scenarios.at(0);
}

struct Hashed : SessionObserver {
  OutputHash hash;
  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override {
    hash.dongle_bytes(now_ns, bytes);
  }
  void robot_tick(std::int64_t now_ns, const RobotSample& sample) override {
    hash.robot_tick(now_ns, sample);
  }
};

struct ImageDrive {
  std::string hash, failure;
  RobotTruth truth{};
  std::vector<std::string> report;
  std::uint64_t missed = 0;
};

// So many milliseconds with this command every 10 ms, by radio.
inline ImageDrive drive_by_radio(Session& session, const RobotCommand& command, int robot, int duration_ms) {
  Hashed seen;
  session.set_observer(&seen);
  std::vector<std::uint8_t> packet, out;
  for (int step = 0; step < duration_ms; ++step) {
    packet.clear();
    if (step % 10 == 0)
      find_radio_format("ulaval-hermes")->encode_command(command, {.robot_id = robot}, packet);
    session.step(packet, out);
  }
  const Firmware& firmware = session.firmware(0);
  return {seen.hash.hex(), std::string(firmware.failure()), session.plant().truth(0), firmware.report(),
          firmware.missed_control_periods()};
}

struct BrokenImage {
  const char* image;
  const char* scenario;
  const char* check;
};
inline constexpr BrokenImage kBrokenImages[] = {{"sign_error", "direction", "commanded_sign"},
                                                {"unlimited_integrator", "wind_up", "wind_up"},
                                                {"no_timeout", "radio_silence", "stops_after_silence"},
                                                {"over_run", "control_period", "control_periods"}};

inline void expect_only_its_check_fails(const SuiteOptions& options, const BrokenImage& broken) {
  for (const BrokenImage& each : kBrokenImages) {
    const std::string name = each.scenario;
    bool passed = true;
    for (const CheckResult& r : run_one(shipped_scenario("wheel/" + name + ".toml"), options).results) {
      passed = passed && r.passed;
      EXPECT_TRUE(r.passed || r.name == broken.check) << failure_line(r);
    }
    EXPECT_EQ(passed, name != broken.scenario) << name;
  }
}

}  // namespace omnihil
