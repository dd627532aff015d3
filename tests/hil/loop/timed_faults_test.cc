// Faults by time: which are in force, that they join, and that a session takes them and a recording keeps them.
#include "hil/loop/timed_faults.h"

#include <gtest/gtest.h>

#include "hil/recording/replay_run.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(TimedFaults, AreInForceFromTheirInstantToBeforeTheirEnd) {
  const std::vector<TimedFault> plan{
      {.key = 3, .from_ns = 10, .until_ns = 20, .faults = {.supply_ratio = 0.5}}};
  EXPECT_EQ(faults_at(plan, 3, 9), RobotFaults{});
  EXPECT_EQ(faults_at(plan, 3, 10).supply_ratio, 0.5);
  EXPECT_EQ(faults_at(plan, 3, 19).supply_ratio, 0.5);
  EXPECT_EQ(faults_at(plan, 3, 20), RobotFaults{});
  EXPECT_EQ(faults_at(plan, 0, 15), RobotFaults{});  // another robot
}

TEST(TimedFaults, ThoseOfOneRobotActTogether) {
  RobotFaults wheel;
  wheel.blocked[1] = true;
  wheel.winding_rise_K = {0.0, 20.0, 0.0, 0.0};
  RobotFaults other;
  other.lifted[2] = true;
  const std::vector<TimedFault> plan{{.key = 0, .faults = {.force_left_N = 2.0, .supply_ratio = 0.5}},
                                     {.key = 0, .faults = {.force_left_N = 1.5, .supply_ratio = 0.8}},
                                     {.key = 0, .faults = wheel},
                                     {.key = 0, .silent = true, .faults = other}};
  const RobotFaults all = faults_at(plan, 0, 0);
  EXPECT_EQ(all.force_left_N, 3.5);
  EXPECT_EQ(all.supply_ratio, 0.4);
  EXPECT_EQ(all.blocked, (PerWheel<bool>{false, true}));
  EXPECT_EQ(all.lifted, (PerWheel<bool>{false, false, true}));
  EXPECT_EQ(all.winding_rise_K[1], 20.0);
  EXPECT_TRUE(silent_at(plan, 0, 0));
  EXPECT_FALSE(silent_at(plan, 1, 0));
}

TEST(TimedFaults, SayWhatIsWrong) {
  const int keys[] = {0, 3};
  const std::vector<TimedFault> plan{
      {.key = 1}, {.key = 0, .from_ns = 5, .until_ns = 5}, {.key = 3, .faults = {.supply_ratio = 3.0}}};
  EXPECT_EQ(fault_problems(plan, keys).size(), 3U);
}

// What the wheel of robot 3 does while it is blocked, and what robot 0 does meanwhile.
TEST(TimedFaults, ASessionTakesThemAndItsRecordingReplays) {
  SessionSetup setup = real::setup(real::kHermes);
  TimedFault blocked{.key = 3, .from_ns = 100 * kMs, .until_ns = 200 * kMs};
  blocked.faults.blocked[2] = true;
  setup.faults = {blocked};
  const Recording run = real::record(setup, 300, 1);
  const auto column = static_cast<std::size_t>(
      std::ranges::find(run.header.columns, "true_omega_wheel_rad_s_3") - run.header.columns.begin());
  ASSERT_LT(column, run.header.columns.size());
  double held = 0.0, before = 0.0, after = 0.0, other = 0.0;
  for (const RecordedChunk& chunk : run.chunks) {
    if (chunk.kind != RecordedChunk::Kind::kSample) continue;
    const double size = std::abs(chunk.sample[column]);
    const bool inside = chunk.now_ns > 110 * kMs && chunk.now_ns < 200 * kMs;
    double& most = chunk.robot_id != 3        ? other
                   : inside                   ? held
                   : chunk.now_ns < 100 * kMs ? before
                   : chunk.now_ns > 210 * kMs ? after
                                              : other;
    most = std::max(most, size);
  }
  EXPECT_LT(held, 0.01);
  EXPECT_GT(before, 2.0);
  EXPECT_GT(after, 2.0);
  EXPECT_GT(other, 2.0);
  const Recording read = real::from_text(real::text_of(run));
  EXPECT_EQ(session_setup(read.header).faults, setup.faults);
  EXPECT_EQ(run_again(read, {}).sha256, run_again(run, {}).sha256);
  Recording healthy = read;
  healthy.header.faults.clear();
  EXPECT_NE(run_again(healthy, {}).sha256, run_again(run, {}).sha256);
}

// No packet passes: commands do not arrive, and the air says so.
TEST(TimedFaults, SilenceLosesTheRobotsPacketsBothWays) {
  SessionSetup setup = real::setup(real::kRem);
  setup.faults = {{.key = 3, .from_ns = 100 * kMs, .until_ns = 400 * kMs, .silent = true}};
  struct Heard : SessionObserver {
    std::array<int, 2> inside{}, outside{};  // of robots 0 and 3
    void delivery(std::int64_t at_ns, const Delivery& delivery) override {
      const bool in = at_ns > 105 * kMs && at_ns < 400 * kMs;
      (in ? inside : outside)[delivery.robot_id == 3 ? 1 : 0] += 1;
    }
  } heard;
  ReplayOptions options;
  options.observer = &heard;
  run_again(real::record(setup, 600), options);
  EXPECT_GT(heard.inside[0], 5);
  EXPECT_EQ(heard.inside[1], 0);
  EXPECT_GT(heard.outside[1], 5);
}

TEST(TimedFaults, AHeaderRefusesWhatItDoesNotKnow) {
  SessionSetup setup = real::setup(real::kHermes);
  RobotFaults all{.force_forward_N = 1.0, .force_left_N = 2.0, .moment_Nm = 0.1, .supply_ratio = 0.9};
  all.winding_rise_K = {1, 2, 3, 4};
  all.lifted = all.blocked = all.encoder_stuck = all.phase_lost = {true, false, true, false};
  setup.faults = {{.key = 3, .from_ns = 5, .until_ns = 9, .silent = true, .faults = all}};
  const std::string json = to_json(recording_header(setup, "abc"));
  std::vector<std::string> problems;
  const auto read = parse_recording_header(json, problems);
  ASSERT_TRUE(read) << problems.at(0);
  EXPECT_EQ(read->faults, setup.faults);
  for (const auto& [from, to] :
       {std::pair{"\"silent\":true", "\"silent\":1"}, std::pair{"\"moment_Nm\"", "\"moment\""},
        std::pair{"\"from_ns\":5,", ""}, std::pair{"\"lifted\":[true,", "\"lifted\":["}}) {
    std::string wrong = json;
    ASSERT_NE(wrong.find(from), std::string::npos) << from;
    wrong.replace(wrong.find(from), std::string(from).size(), to);
    problems.clear();
    EXPECT_FALSE(parse_recording_header(wrong, problems)) << to;
  }
}

}  // namespace
}  // namespace omnihil
