// What the air takes: shares against theory, bursts, distance, and that a recording replays with it.
#include "hil/loop/air_loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hil/recording/replay_run.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

constexpr int kMany = 200'000;

// Standard error of a share of kMany independent packets.
double error_of(double share) { return std::sqrt(share * (1.0 - share) / kMany); }

double share_lost(const AirOptions& options, double x_m = 0.0, std::uint64_t seed = 11) {
  AirLoss air(options, seed, [x_m](int) { return std::pair(x_m, 0.0); });
  for (int n = 0; n < kMany; ++n) air.lost(3, AirWay::kToRobot);
  EXPECT_EQ(air.counts().sent_to_robot, static_cast<std::uint64_t>(kMany));
  EXPECT_EQ(air.counts().sent_to_host, 0U);
  return static_cast<double>(air.counts().to_robot) / kMany;
}

TEST(AirLoss, AShareIsThatShare) {
  EXPECT_EQ(share_lost({}), 0.0);
  EXPECT_EQ(share_lost({.share = 1.0}), 1.0);
  EXPECT_NEAR(share_lost({.share = 0.02}), 0.02, 4.0 * error_of(0.02));
}

TEST(AirLoss, DistanceIsTheSeedPapers) {
  EXPECT_NEAR(distance_loss_mean(5.0), 0.01, 1e-12);  // atan(0)
  EXPECT_NEAR(distance_loss_mean(0.0), 0.01 * (1.0 - 2.0 / M_PI * std::atan(2.0)), 1e-12);
  EXPECT_LT(distance_loss_mean(1e6), 0.02);  // the limit, never reached
  EXPECT_NEAR(distance_loss_mean(1e6), 0.02, 1e-7);
  EXPECT_EQ(distance_loss_sigma(0.0), 0.0);
  EXPECT_NEAR(distance_loss_sigma(5.0), 0.0003 * std::log(2.0), 1e-15);
  for (const double d : {0.0, 5.0, 12.0}) {
    const double mean = distance_loss_mean(d);
    EXPECT_NEAR(share_lost({.by_distance = true, .x_m = -2.0}, d - 2.0), mean, 4.0 * error_of(mean)) << d;
  }
}

// Gilbert and Elliott: the bad state holds bad / (good + bad) of the packets; a run of losses of a state that loses all
// has the state's mean length.
TEST(AirLoss, BurstsHaveTheirShareAndTheirLength) {
  const AirOptions bursts{.burst_good_packets = 200.0, .burst_bad_packets = 8.0, .burst_share = 1.0};
  AirLoss air(bursts, 5, [](int) { return std::pair(0.0, 0.0); });
  int lost = 0, runs = 0;
  bool before = false;
  for (int n = 0; n < 20 * kMany; ++n) {
    const bool gone = air.lost(0, AirWay::kToHost);
    lost += gone ? 1 : 0;
    runs += gone && !before ? 1 : 0;
    before = gone;
  }
  EXPECT_NEAR(static_cast<double>(lost) / (20.0 * kMany), 8.0 / 208.0,
              0.002);                                        // 19 000 runs: 1 % of the share
  EXPECT_NEAR(static_cast<double>(lost) / runs, 8.0, 0.25);  // geometric: sigma 7.5 / sqrt(runs)
}

TEST(AirLoss, RobotsAndWaysHaveBurstsOfTheirOwn) {
  const AirOptions bursts{.burst_good_packets = 50.0, .burst_bad_packets = 50.0, .burst_share = 1.0};
  AirLoss air(bursts, 5, [](int) { return std::pair(0.0, 0.0); });
  int differ = 0;
  for (int n = 0; n < 10'000; ++n) {
    const bool a = air.lost(0, AirWay::kToRobot), b = air.lost(1, AirWay::kToRobot),
               c = air.lost(0, AirWay::kToHost);
    differ += (a != b || a != c) ? 1 : 0;
  }
  EXPECT_GT(differ, 5'000);  // three chains of half and half differ in three of four
}

TEST(AirLoss, OthersCollideAsInAloha) {
  const double share = 1.0 - std::exp(-2.0 * 0.05);
  EXPECT_NEAR(share_lost({.others_load = 0.05}), share, 4.0 * error_of(share));
}

TEST(AirLoss, SaysWhatIsWrong) {
  EXPECT_TRUE(air_problems({}).empty());
  EXPECT_EQ(air_problems({.share = 1.5}).size(), 1U);
  EXPECT_EQ(air_problems({.burst_good_packets = 10.0}).size(), 1U);  // bursts of no length
}

class LossyAir : public testing::TestWithParam<real::Case> {};

// Every dongle: what is lost did not reach the robot and is not answered, and the recording replays to the same bytes.
TEST_P(LossyAir, DropsCommandsAndAnswersAndReplays) {
  SessionSetup setup = real::setup(GetParam());
  const Recording whole = real::record(setup, 1500);
  setup.air.share = 1.0;
  const Recording none = real::record(setup, 1500);
  std::size_t deliveries = 0;
  struct Counter : SessionObserver {
    std::size_t& n;
    explicit Counter(std::size_t& count) : n(count) {}
    void delivery(std::int64_t, const Delivery&) override { ++n; }
  } counter(deliveries);
  ReplayOptions options;
  options.observer = &counter;
  EXPECT_TRUE(run_again(none, options).sha256.size() == 64);
  EXPECT_EQ(deliveries, 0U);
  for (const RecordedChunk& chunk : none.chunks) {
    if (chunk.kind != RecordedChunk::Kind::kSample) continue;
    EXPECT_EQ(chunk.sample[0], 0.0);  // duty of a robot that heard nothing
  }
  setup.air.share = 0.3;
  const Recording some = real::record(setup, 1500);
  deliveries = 0;
  const ReplayRun again = run_again(real::from_text(real::text_of(some)), options);
  const std::size_t reached = deliveries;
  deliveries = 0;
  run_again(whole, options);
  EXPECT_LT(reached, deliveries);
  EXPECT_GT(reached, deliveries / 3);
  RecordingHeader header = some.header;
  EXPECT_EQ(session_setup(header).air, setup.air);
  // the same bytes as were recorded
  std::size_t bytes = 0;
  for (const RecordedChunk& chunk : some.chunks)
    bytes += chunk.kind == RecordedChunk::Kind::kDongleBytes ? chunk.bytes.size() : 0;
  std::size_t replayed = 0;
  for (const RecordedChunk& chunk : again.answer.chunks)
    replayed += chunk.kind == RecordedChunk::Kind::kDongleBytes ? chunk.bytes.size() : 0;
  EXPECT_EQ(bytes, replayed);
  EXPECT_GT(bytes, 0U);
}

// All of it at once: the recording, as text and back, replays to the same bytes and values.
TEST_P(LossyAir, LateDoubleAndWrongPacketsReplayExactly) {
  SessionSetup setup = real::setup(GetParam());
  setup.air = {.share = 0.05,
               .latency_least_s = 0.001,
               .latency_mean_s = 0.006,
               .twice_share = 0.1,
               .held_share = 0.1,
               .held_s = 0.025,
               .bit_error_rate = 1e-3};
  const Recording run = real::record(setup, 1500);
  const Recording read = real::from_text(real::text_of(run));
  EXPECT_EQ(session_setup(read.header).air, setup.air);
  const ReplayRun again = run_again(read, {});
  const auto bytes_of = [](const Recording& recording) {
    std::vector<std::pair<std::int64_t, std::vector<std::uint8_t>>> bytes;
    for (const RecordedChunk& chunk : recording.chunks)
      if (chunk.kind == RecordedChunk::Kind::kDongleBytes) bytes.emplace_back(chunk.now_ns, chunk.bytes);
    return bytes;
  };
  EXPECT_GT(bytes_of(run).size(), 5U);
  EXPECT_EQ(bytes_of(run), bytes_of(again.answer));
  EXPECT_EQ(run_again(read, {}).sha256, again.sha256);
  setup.plant.seed = 12;
  EXPECT_NE(bytes_of(real::record(setup, 1500)), bytes_of(run));
}

INSTANTIATE_TEST_SUITE_P(Dongles, LossyAir, testing::Values(real::kHermes, real::kRem),
                         [](const auto& param) { return std::string(param.param.robot); });

TEST(AirInAHeader, UnknownKeysAndNumbersOutOfRangeAreRefused) {
  SessionSetup setup = real::setup(real::kHermes);
  setup.air = {.share = 0.1,
               .by_distance = true,
               .x_m = -4.5,
               .burst_good_packets = 100.0,
               .burst_bad_packets = 5.0,
               .burst_share = 0.9,
               .others_load = 0.01,
               .latency_least_s = 0.001,
               .latency_mean_s = 0.004,
               .latency_law = LatencyLaw::kLognormal,
               .latency_sigma = 0.5,
               .in_order = true,
               .twice_share = 0.03,
               .held_share = 0.02,
               .held_s = 0.015,
               .bit_error_rate = 1e-5};
  const std::string json = to_json(recording_header(setup, "abc"));
  std::vector<std::string> problems;
  const auto read = parse_recording_header(json, problems);
  ASSERT_TRUE(read) << problems.at(0);
  EXPECT_EQ(read->air, setup.air);
  for (const auto& [from, to] :
       {std::pair{"\"share\":0.1", "\"share\":7"}, std::pair{"\"share\"", "\"shore\""},
        std::pair{"lognormal", "abnormal"}, std::pair{"\"in_order\":true", "\"in_order\":1.5"}}) {
    std::string wrong = json;
    wrong.replace(wrong.find(from), std::string(from).size(), to);
    problems.clear();
    EXPECT_FALSE(parse_recording_header(wrong, problems)) << to;
    EXPECT_FALSE(problems.empty());
  }
}

}  // namespace
}  // namespace omnihil
