// A stream that a real AI host wrote, at its own times, into the dongle: nothing refused, nothing lost.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

struct TimedFrame {
  std::int64_t at_ns;
  Bytes bytes;
};

// The rows of the recording: [seconds since the first frame, "hex"].
std::vector<TimedFrame> read_stream(std::istream& file) {
  std::vector<TimedFrame> frames;
  const nlohmann::json recording = nlohmann::json::parse(file);
  for (const nlohmann::json& row : recording.at("sessions").at("lineup")) {
    TimedFrame frame{std::llround(row.at(0).get<double>() * 1e9), {}};
    const auto hex = row.at(1).get<std::string>();
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
      frame.bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

// What such a host writes, made here: a burst for six robots every 16 ms, each robot at a speed of its own.
std::vector<TimedFrame> made_stream() {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  std::vector<TimedFrame> frames;
  for (int burst = 0; burst < 60; ++burst) {
    for (int robot = 0; robot < 6; ++robot) {
      const double vx_m_s = 0.25 * robot + 0.125 * (burst % 8);  // exact in float32
      frames.push_back(
          {burst * 16 * kMs, encode(format, "SPEED_MOVE_ADVANCE", {{"robot", robot}, {"vx", vx_m_s}})});
    }
  }
  return frames;
}

void expect_heard_in_order_and_in_time(const std::vector<TimedFrame>& frames) {
  Bench bench("ulaval-hermes", {.robot_ids = {0, 1, 2, 3, 4, 5}, .team = Team::kBlue});
  bench.boot_robots();
  for (const TimedFrame& frame : frames) {
    bench.run_to(frame.at_ns, kMs);
    bench.write(frame.bytes);
  }
  bench.run_to(bench.now_ns + 20 * kMs, kMs);
  EXPECT_EQ(bench.good(), frames.size());
  EXPECT_EQ(bench.link->from_host().refused(), 0u);
  ASSERT_EQ(bench.sink.heard.size(), frames.size());
  std::int64_t longest_ns = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Values values = bench.format.decode(frames[i].bytes).values;
    EXPECT_EQ(bench.sink.heard[i].robot, static_cast<int>(values.number("robot"))) << i;
    EXPECT_EQ(bench.sink.heard[i].command.v_forward_m_s, values.number("vx")) << i;
    longest_ns = std::max(longest_ns, bench.sink.heard[i].at_ns - frames[i].at_ns);
  }
  // A burst of six takes 6 * 0.574 ms; no frame waits for more than one burst before its own.
  EXPECT_LT(longest_ns, 2 * 6 * 574 * kUs);
  std::printf("longest way from host to robot: %.3f ms\n", static_cast<double>(longest_ns) * 1e-6);
  for (int id = 0; id < 6; ++id) EXPECT_GT(bench.sink.of_robot(id).size(), 20u) << id;
}

TEST(HostStreamTest, EveryFrameOfBurstsReachesItsRobotInOrderAndInTime) {
  expect_heard_in_order_and_in_time(made_stream());
}

TEST(HostStreamTest, EveryFrameOfTheRealHostReachesItsRobotInOrderAndInTime) {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr)
    GTEST_SKIP() << "OMNIHIL_SHARED is not set: the recorded stream of a real host is not here";
  const std::string path = std::string(shared) + "/vectors/ulaval-strategyai-host-stream.json";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << path << " does not exist";
  const std::vector<TimedFrame> frames = read_stream(file);
  ASSERT_EQ(frames.size(), 1035u);
  expect_heard_in_order_and_in_time(frames);
}

}  // namespace
}  // namespace omnihil
