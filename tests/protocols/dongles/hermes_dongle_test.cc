// ULaval's dongle: framing, air time, answers, and what its robots make of the packets.
#include "protocols/dongles/hermes_air.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

// Settling 130 us, then 8 + 40 + 9 + 23 * 8 + 8 = 249 bits at 1 Mb/s.
constexpr std::int64_t kFrame = 130 * kUs + 249 * kUs;
// The acknowledgement has no payload: 130 us and 65 bits.
constexpr std::int64_t kAck = 130 * kUs + 65 * kUs;
constexpr std::int64_t kNoAck = 1000 * kUs;

Bench make_bench(std::vector<int> ids, bool firmware_decodes = false) {
  RadioLinkConfig config;
  config.robot_ids = std::move(ids);
  config.firmware_decodes = firmware_decodes;
  return Bench("ulaval-hermes", config);
}

Bytes speed(const Bench& bench, int robot, double vx) {
  return bench.encode("SPEED_MOVE", {{"robot", robot}, {"vx", vx}});
}

TEST(HermesDongleTest, FrameReachesItsRobotAfterSettlingAndAirTime) {
  Bench bench = make_bench({3});
  bench.now_ns = 10 * kMs;
  bench.write(speed(bench, 3, 0.5));
  bench.run_to(20 * kMs, 10 * kUs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].robot, 3);
  EXPECT_EQ(bench.sink.heard[0].at_ns, 10 * kMs + kFrame);
  EXPECT_EQ(bench.sink.heard[0].message, "SPEED_MOVE");
  EXPECT_EQ(bench.good(), 1u);
}

TEST(HermesDongleTest, BurstForSixRobotsGoesOneFrameAtATime) {
  Bench bench = make_bench({0, 1, 2, 3, 4, 5});
  Bytes burst;
  for (int id = 0; id < 6; ++id) burst = burst + speed(bench, id, 0.1 * id);
  bench.write(burst);
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 6u);
  for (int id = 0; id < 6; ++id) {
    const Heard& heard = bench.sink.heard[static_cast<std::size_t>(id)];
    EXPECT_EQ(heard.robot, id);
    EXPECT_EQ(heard.at_ns, id * (kFrame + kAck) + kFrame);
    EXPECT_NEAR(heard.command.v_forward_m_s, 0.1 * id, 1e-7);
  }
}

TEST(HermesDongleTest, FrameToAnAbsentRobotIsCountedAndHoldsTheChannelUntilNoAckCame) {
  Bench bench = make_bench({1});
  bench.write(speed(bench, 7, 1.0) + speed(bench, 1, 1.0));
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].robot, 1);
  EXPECT_EQ(bench.sink.heard[0].at_ns, kFrame + kNoAck + kFrame);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  EXPECT_EQ(bench.good(), 1u);
}

TEST(HermesDongleTest, FrameAgainAfterThreeOtherRobotsIsSentTwiceAndActedOnOnce) {
  Bench bench = make_bench({0, 1, 2, 3});
  Bytes frames;
  for (const int id : {0, 1, 2, 3, 0, 1}) frames = frames + speed(bench, id, 1.0);
  bench.write(frames);
  bench.run_to(20 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 6u);
  const std::int64_t one = kFrame + kAck;
  EXPECT_EQ(bench.sink.heard[4].at_ns, 4 * one + kFrame);
  EXPECT_EQ(bench.sink.heard[5].at_ns, 6 * one + kFrame);  // the fifth took two
}

TEST(HermesDongleTest, QueueHoldsWhatTheDonglesRingHoldsAndCountsTheRestAsOverrun) {
  Bench bench = make_bench({0});
  Bytes frames;
  for (int i = 0; i < 200; ++i) frames = frames + speed(bench, 0, i);
  bench.write(frames);
  EXPECT_EQ(bench.good(), 149u);
  EXPECT_EQ(bench.refused(PacketError::kOverrun), 51u);
  bench.run_to(200 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 149u);
}

TEST(HermesDongleTest, BatteryIsAnsweredInDecivolts) {
  Bench bench = make_bench({2});
  bench.robots[2].battery_V = 24.69;  // truncated
  bench.run_to(1 * kMs);
  bench.write(bench.encode("GET_BATTERIE", {{"robot", 2}}));
  bench.run_to(1 * kMs + 5 * kMs);
  const auto answers = bench.answers();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].values.message->name, "BATTERIE_RESPONSE");
  EXPECT_EQ(answers[0].values.number("decivolts"), 246.0);
  EXPECT_EQ(answers[0].values.number("robot"), 2.0);
  EXPECT_EQ(answers[0].values.number("destination"), 0.0);
  EXPECT_EQ(bench.link->from_robots().good, 1u);
}

TEST(HermesDongleTest, AnswerHoldsTheChannelUntilItIsThere) {
  Bench bench = make_bench({0, 1});
  bench.boot_robots();
  bench.step();
  bench.write(bench.encode("PING_REQUEST", {{"robot", 0}}) + speed(bench, 1, 1.0));
  bench.run_to(10 * kMs);
  // Request, 1 ms in the robot, answer on the air, then the next frame.
  const std::int64_t answered = kFrame + hermes::kRobotTurnaround_ns + kFrame;
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].at_ns, answered + kFrame);
  EXPECT_EQ(bench.answers("PING_RESPONSE").size(), 1u);
}

TEST(HermesDongleTest, SilentRobotIsAskedThreeTimesForFiveMillisecondsEach) {
  Bench bench = make_bench({0, 1}, true);
  bench.write(bench.encode("PING_REQUEST", {{"robot", 0}}) + speed(bench, 1, 1.0));
  bench.run_to(30 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 4u);
  const std::int64_t one_try = kFrame + kAck + 5 * kMs;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(bench.sink.heard[static_cast<std::size_t>(i)].message, "PING_REQUEST");
    EXPECT_EQ(bench.sink.heard[static_cast<std::size_t>(i)].at_ns, i * one_try + kFrame);
  }
  EXPECT_EQ(bench.sink.heard[3].robot, 1);
  EXPECT_EQ(bench.sink.heard[3].at_ns, 3 * one_try + kFrame);
}

TEST(HermesDongleTest, CounterIsAskedForOnceOnlyAndCountsEverythingElse) {
  Bench bench = make_bench({0, 1});
  bench.boot_robots();
  bench.step();
  const Bytes ask = bench.encode("GET_NUM_REQUEST", {{"robot", 1}});
  bench.write(speed(bench, 1, 1.0) + speed(bench, 0, 1.0) + ask + speed(bench, 1, 2.0) + ask);
  bench.run_to(30 * kMs);
  const auto answers = bench.answers("NUM_REQUEST_RESPONSE");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].values.number("value"), 1.0);
  EXPECT_EQ(answers[1].values.number("value"), 2.0);

  Bench silent = make_bench({0, 1}, true);
  silent.write(silent.encode("GET_NUM_REQUEST", {{"robot", 0}}) + speed(silent, 1, 1.0));
  silent.run_to(30 * kMs);
  ASSERT_EQ(silent.sink.heard.size(), 2u);
  EXPECT_EQ(silent.sink.heard[1].at_ns, kFrame + kAck + 5 * kMs + kFrame);
}

TEST(HermesDongleTest, FirmwareGetsTheFrameAsItStoodOnTheWire) {
  Bench bench = make_bench({4}, true);
  const Bytes frame = bench.encode("SPEED_MOVE_ADVANCE", {{"robot", 4}, {"vx", 0.25}, {"dribbler", 2}});
  bench.write(frame);
  bench.run_to(2 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].kind, Delivery::Kind::kFrame);
  EXPECT_EQ(bench.sink.heard[0].frame, frame);
}

TEST(HermesDongleTest, FirmwaresOwnAnswerGoesToTheHostAndALateOneDoesNot) {
  Bench bench = make_bench({4}, true);
  const Bytes answer = bench.encode("PING_RESPONSE", {{"robot", 4}});
  bench.write(bench.encode("PING_REQUEST", {{"robot", 4}}));
  bench.run_to(2 * kMs);
  bench.link->robot_frame(4, answer, bench.now_ns);
  bench.run_to(4 * kMs);
  EXPECT_EQ(bench.to_host, answer);
  bench.link->robot_frame(4, answer, bench.now_ns);
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.to_host, answer);
  EXPECT_EQ(bench.link->from_robots().good, 1u);
  EXPECT_EQ(bench.link->from_robots().bad[static_cast<std::size_t>(PacketError::kOverrun)], 1u);
}

TEST(HermesDongleTest, PaddingBehindAnAnswerIsNotPassedOn) {
  Bench bench = make_bench({4}, true);
  const Bytes answer = bench.encode("PING_RESPONSE", {{"robot", 4}});
  Bytes payload = answer;
  payload.resize(hermes::kPayloadBytes, 0x5A);
  bench.write(bench.encode("PING_REQUEST", {{"robot", 4}}));
  bench.run_to(2 * kMs);
  bench.link->robot_frame(4, payload, bench.now_ns);
  bench.run_to(4 * kMs);
  EXPECT_EQ(bench.to_host, answer);
}

TEST(HermesDongleTest, AnswerBeforeItsRequestOrFromAnotherRobotIsNotTaken) {
  Bench bench = make_bench({4, 5}, true);
  bench.write(bench.encode("PING_REQUEST", {{"robot", 4}}));
  bench.run_to(kFrame - 1 * kUs);
  bench.link->robot_frame(4, bench.encode("PING_RESPONSE", {{"robot", 4}}), bench.now_ns);
  bench.run_to(1 * kMs);
  bench.link->robot_frame(5, bench.encode("PING_RESPONSE", {{"robot", 5}}), bench.now_ns);
  bench.run_to(30 * kMs);
  EXPECT_TRUE(bench.to_host.empty());
  EXPECT_EQ(bench.link->from_robots().bad[static_cast<std::size_t>(PacketError::kOverrun)], 1u);
  EXPECT_EQ(bench.link->from_robots().bad[static_cast<std::size_t>(PacketError::kAddress)], 1u);
}

TEST(HermesDongleTest, BadAnswersOfFirmwareAreCountedByCauseAndNotPassedOn) {
  Bench bench = make_bench({4}, true);
  bench.write(bench.encode("PING_REQUEST", {{"robot", 4}}));
  bench.run_to(1 * kMs);
  Bytes broken = bench.encode("BATTERIE_RESPONSE", {{"robot", 4}, {"decivolts", 200}});
  broken[broken.size() - 2] ^= 1u;
  bench.link->robot_frame(4, broken, bench.now_ns);
  bench.link->robot_frame(4, speed(bench, 4, 1.0), bench.now_ns);
  bench.run_to(30 * kMs);
  EXPECT_TRUE(bench.to_host.empty());
  const PacketCounts& counts = bench.link->from_robots();
  EXPECT_EQ(counts.bad[static_cast<std::size_t>(PacketError::kChecksum)], 1u);
  EXPECT_EQ(counts.bad[static_cast<std::size_t>(PacketError::kDirection)], 1u);
}

TEST(HermesDongleTest, ClosingCountsAHalfFrameOnceAndLeavesTheQueueToTheRobots) {
  Bench bench = make_bench({0});
  const Bytes frame = speed(bench, 0, 1.0);
  bench.write(frame + Bytes(frame.begin(), frame.begin() + 7));
  bench.link->host_closed(bench.now_ns);
  bench.link->host_closed(bench.now_ns);
  EXPECT_EQ(bench.refused(PacketError::kTooShort), 1u);
  bench.write(frame);
  bench.run_to(5 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 2u);
  EXPECT_EQ(bench.good(), 2u);
}

TEST(HermesDongleTest, DeliveriesDoNotDependOnHowOftenTheLinkIsPolled) {
  const auto run = [](std::int64_t step_ns) {
    Bench bench = make_bench({0, 1, 2, 3});
    bench.boot_robots();
    bench.step();
    for (int i = 0; i < 40; ++i) {
      bench.write(speed(bench, i % 4, 0.01 * i) + bench.encode("PING_REQUEST", {{"robot", (i + 1) % 5}}));
      bench.run_to(bench.now_ns + 20 * kMs, step_ns);
    }
    return bench.sink.heard;
  };
  const auto fine = run(50 * kUs);
  EXPECT_EQ(fine.size(), 40u);
  EXPECT_TRUE(same(fine, run(1 * kMs)));
  EXPECT_TRUE(same(fine, run(20 * kMs)));
}

}  // namespace
}  // namespace omnihil
