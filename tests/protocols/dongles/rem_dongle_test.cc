// RoboTeam's base station: slots, queues, addresses, answers. Both versions where nothing else is said.
#include "protocols/dongles/rem_air.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

constexpr std::int64_t kSlot = kS / 960;  // rounded down; slot k begins at k / 960 s

class RemDongleTest : public ::testing::TestWithParam<const char*> {
 protected:
  Bench make_bench(std::vector<int> ids, Team team = Team::kYellow, bool firmware_decodes = false) const {
    RadioLinkConfig config;
    config.robot_ids = std::move(ids);
    config.team = team;
    config.firmware_decodes = firmware_decodes;
    config.epoch_ms = 1'700'000'000'000;
    return Bench(GetParam(), config);
  }
  static std::vector<int> all_ids() { return {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}; }
  bool v5() const { return std::string_view(GetParam()) == "roboteam-rem-v5"; }
};

Bytes command(const Bench& bench, int robot, double rho) {
  return bench.encode("REM_RobotCommand", {{"toRobotId", robot}, {"rho", rho}});
}

INSTANTIATE_TEST_SUITE_P(Versions, RemDongleTest, ::testing::Values("roboteam-rem-v8", "roboteam-rem-v5"),
                         [](const auto& param) { return std::string(param.param).substr(13); });

TEST_P(RemDongleTest, TimerServesEachOfSixteenIdsSixtyTimesASecond) {
  Bench bench = make_bench(all_ids());
  while (bench.now_ns < kS) {
    for (int id = 0; id < 16; ++id) bench.write(command(bench, id, 1.0));
    bench.run_to(bench.now_ns + 1 * kMs, 250 * kUs);
  }
  for (int id = 0; id < 16; ++id) {
    const auto heard = bench.sink.of_robot(id);
    EXPECT_GE(heard.size(), 59u) << id;
    EXPECT_LE(heard.size(), 60u) << id;
    for (std::size_t i = 1; i < heard.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(heard[i].at_ns - heard[i - 1].at_ns), 16.0 / 960.0 * 1e9, 1.0) << id;
    }
  }
}

TEST_P(RemDongleTest, RobotsOwnSlotCarriesItsCommand) {
  Bench bench = make_bench(all_ids());
  bench.now_ns = 1 * kMs;  // slot 0 is over
  for (int id = 0; id < 16; ++id) bench.write(command(bench, id, 0.1 * id));
  bench.run_to(25 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 16u);
  const auto size = static_cast<std::size_t>(bench.format.find("REM_RobotCommand")->size_bytes);
  for (std::size_t k = 1; k <= 16; ++k) {
    const Heard& heard = bench.sink.heard[k - 1];
    EXPECT_EQ(heard.robot, static_cast<int>(k % 16));
    EXPECT_NEAR(static_cast<double>(heard.at_ns - rem::air_time_ns(size)),
                static_cast<double>(k) * 1e9 / 960.0, 1.0);
  }
}

TEST_P(RemDongleTest, AirTimeOfAPacketIsThatOfFlrc) {
  // 28 bytes: 56 bits plain, (224 + 16 + 6) * 4/3 = 328 bits coded, at 1.3 Mb/s
  EXPECT_EQ(rem::air_time_ns(28), static_cast<std::int64_t>((56.0 + 328.0) / 1.3e6 * 1e9));
}

TEST_P(RemDongleTest, LastCommandBeforeTheSlotWins) {
  Bench bench = make_bench({5});
  for (const double rho : {1.0, 2.0, 3.0}) bench.write(command(bench, 5, rho));
  bench.run_to(40 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_NEAR(bench.sink.heard[0].command.v_forward_m_s, 3.0, 1e-3);
  EXPECT_EQ(bench.good(), 3u);
  EXPECT_EQ(bench.link->from_host().refused(), 0u);
}

TEST_P(RemDongleTest, CommandWrittenAfterTheSlotWaitsForTheNextOne) {
  Bench bench = make_bench({0});
  bench.now_ns = 100 * kUs;
  bench.write(command(bench, 0, 1.0));
  bench.run_to(30 * kMs, 10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_GT(bench.sink.heard[0].at_ns, 16 * kSlot);
}

TEST_P(RemDongleTest, FortyPacketsWaitPerRobotAndTheRestIsOverrun) {
  Bench bench = make_bench({0, 1});
  for (int i = 0; i < 50; ++i)
    bench.write(bench.encode("REM_RobotBuzzer", {{"toRobotId", 1}, {"period", i}}));
  EXPECT_EQ(bench.good(), 40u);
  EXPECT_EQ(bench.refused(PacketError::kOverrun), 10u);
  bench.write(bench.encode("REM_RobotBuzzer", {{"toRobotId", 0}}));
  EXPECT_EQ(bench.good(), 41u);
}

TEST_P(RemDongleTest, PacketsAreStitchedUpTo127BytesAndTheRestWaits) {
  Bench bench = make_bench({2}, Team::kYellow, true);
  const Bytes set = bench.encode("REM_RobotSetPIDGains", {{"toRobotId", 2}});
  const std::size_t per_slot = 127 / set.size();
  bench.write(set + set + set + set);
  bench.run_to(100 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto k = static_cast<double>(2 + 16 * (i / per_slot));
    const std::size_t in_slot = std::min(per_slot, 4 - i / per_slot * per_slot);
    const auto air = static_cast<double>(rem::air_time_ns(in_slot * set.size()));
    EXPECT_NEAR(static_cast<double>(bench.sink.heard[i].at_ns), k * 1e9 / 960.0 + air, 1.0) << i;
    EXPECT_EQ(bench.sink.heard[i].frame, set);
  }
}

TEST_P(RemDongleTest, RobotAnswersWithinAMillisecondWithItsHeaderRight) {
  for (const Team team : {Team::kYellow, Team::kBlue}) {
    Bench bench = make_bench({7}, team);
    bench.boot_robots();
    bench.step();
    const double color = team == Team::kBlue ? 1.0 : 0.0;
    bench.write(bench.encode("REM_RobotCommand",
                             {{"toRobotId", 7}, {"toColor", color}, {"messageId", 11}, {"rho", 1.0}}));
    while (bench.sink.heard.empty()) bench.run_to(bench.now_ns + 10 * kUs);
    const std::int64_t delivered = bench.sink.heard[0].at_ns;
    EXPECT_TRUE(bench.to_host.empty());
    bench.run_to(delivered + 1 * kMs, 10 * kUs);
    const auto feedback = bench.answers("REM_RobotFeedback");
    ASSERT_EQ(feedback.size(), 1u);
    const Values& values = feedback[0].values;
    EXPECT_EQ(values.number("fromRobotId"), 7.0);
    EXPECT_EQ(values.number("fromColor"), color);
    EXPECT_EQ(values.number("toPC"), 1.0);
    EXPECT_EQ(values.number("toBS"), 0.0);
    EXPECT_EQ(values.number("fromBS"), 0.0);
    EXPECT_EQ(values.number("messageId"), 11.0);  // given back
    const double unit_ms = v5() ? 10.0 : 1.0;
    EXPECT_NEAR(values.number("timestamp") * unit_ms, 1.7e12 + static_cast<double>(delivered) * 1e-6,
                unit_ms + 1.0);
    EXPECT_GE(bench.link->from_robots().good, 1u);
  }
}

// What a firmware's own radio sends is one frame, however many packets are in it.
TEST_P(RemDongleTest, PacketsThatARobotStitchesTogetherAllReachTheHost) {
  Bench bench = make_bench({7}, Team::kYellow, true);
  const Bytes feedback =
      bench.encode("REM_RobotFeedback", {{"fromRobotId", 7}, {"toPC", 1}, {"batteryLevel", 15}});
  const Bytes state = bench.encode("REM_RobotStateInfo", {{"fromRobotId", 7}, {"toPC", 1}});
  Bytes both = feedback;
  both.insert(both.end(), state.begin(), state.end());
  bench.link->robot_frame(7, both, bench.now_ns);
  Bytes out;
  bench.link->take_host_bytes(bench.now_ns, out);
  EXPECT_EQ(out, both);
  Bytes cut(both.begin(), both.end() - 5);  // the second is short: it alone is refused
  bench.link->robot_frame(7, cut, bench.now_ns);
  out.clear();
  bench.link->take_host_bytes(bench.now_ns, out);
  EXPECT_EQ(out, feedback);
}

TEST_P(RemDongleTest, RobotThatIsNotSpokenToIsSilent) {
  Bench bench = make_bench({0, 1});
  bench.boot_robots();
  bench.step();
  bench.write(command(bench, 0, 1.0));
  bench.run_to(500 * kMs);
  const auto all = bench.answers();
  ASSERT_FALSE(all.empty());
  for (const DecodeResult& answer : all) EXPECT_EQ(answer.values.number("fromRobotId"), 0.0);
  EXPECT_EQ(bench.answers("REM_RobotFeedback").size(), 1u);
}

TEST_P(RemDongleTest, StateInfoComesWhenAskedForAndInV5Always) {
  Bench bench = make_bench({0});
  bench.boot_robots();
  bench.step();
  bench.write(command(bench, 0, 1.0));
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.answers("REM_RobotStateInfo").size(), v5() ? 1u : 0u);
  if (v5()) return;
  bench.write(bench.encode("REM_RobotCommand", {{"sendStateInfo", 1}}));
  bench.run_to(40 * kMs);
  EXPECT_EQ(bench.answers("REM_RobotStateInfo").size(), 1u);
}

TEST_P(RemDongleTest, GainsGoToTheRobotAndComeBackWhenAsked) {
  Bench bench = make_bench({4});
  bench.boot_robots();
  bench.gains.p[2] = 7.5;
  bench.gains.d2[0] = 3.0;
  bench.step();
  bench.write(bench.encode(
      "REM_RobotSetPIDGains",
      {{"toRobotId", 4}, {"PbodyX", 2.0}, {"IbodyYaw", 1.5}, {"Pwheels", 4.0}, {"Dwheels", 0.5}}));
  bench.run_to(20 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  const Heard& set = bench.sink.heard[0];
  EXPECT_EQ(set.kind, Delivery::Kind::kGains);
  EXPECT_NEAR(set.gains.p[0], 2.0, 2e-3);
  EXPECT_NEAR(set.gains.i[3], 1.5, 2e-3);
  EXPECT_NEAR(set.gains.p[4], 4.0, 2e-3);
  EXPECT_NEAR(set.gains.d[4], 0.5, 2e-3);
  EXPECT_EQ(set.gains.p[2], 0.0);
  EXPECT_EQ(set.gains.d2[0], v5() ? 3.0 : 0.0);  // v5 has no D2: what the robot has stays
  EXPECT_TRUE(bench.answers("REM_RobotPIDGains").empty());

  bench.write(bench.encode("REM_RobotGetPIDGains", {{"toRobotId", 4}}));
  bench.run_to(40 * kMs);
  const auto gains = bench.answers("REM_RobotPIDGains");
  ASSERT_EQ(gains.size(), 1u);
  EXPECT_NEAR(gains[0].values.number("PbodyW"), 7.5, 2e-3);
  EXPECT_EQ(gains[0].values.number("fromRobotId"), 4.0);
}

TEST_P(RemDongleTest, AssuredPacketIsAcknowledgedWithItsNumber) {
  Bench bench = make_bench({1});
  bench.boot_robots();
  bench.step();
  for (const int number : {200, 7}) {
    bench.write(bench.encode("REM_RobotAssuredPacket", {{"toRobotId", 1}, {"sequenceNumber", number}}));
  }
  bench.run_to(20 * kMs);
  const auto acks = bench.answers("REM_RobotAssuredAck");
  ASSERT_EQ(acks.size(), 2u);
  EXPECT_EQ(acks[0].values.number("sequenceNumber"), 200.0);
  EXPECT_EQ(acks[1].values.number("sequenceNumber"), 7.0);
  EXPECT_EQ(acks[1].values.number("messageId"), acks[0].values.number("messageId") + 1.0);
}

TEST_P(RemDongleTest, AnswerNeverExceeds127BytesAndWhatIsAskedForOnceGoesFirst) {
  Bench bench = make_bench({0});
  bench.boot_robots();
  bench.step();
  Bytes burst = bench.encode("REM_RobotCommand", {{"rho", 1.0}});
  if (!v5()) burst = bench.encode("REM_RobotCommand", {{"sendStateInfo", 1}});
  burst = burst + bench.encode("REM_RobotGetPIDGains", {});
  for (int i = 0; i < 5; ++i) burst = burst + bench.encode("REM_RobotAssuredPacket", {{"sequenceNumber", i}});
  bench.now_ns = 1 * kMs;
  bench.write(burst);
  bench.run_to(20 * kMs);
  EXPECT_LE(bench.to_host.size(), 127u);
  EXPECT_EQ(bench.answers("REM_RobotPIDGains").size(), 1u);
  EXPECT_TRUE(bench.answers("REM_RobotStateInfo").empty());
  const std::size_t first = bench.answers("REM_RobotAssuredAck").size();
  EXPECT_GE(first, 4u);
  bench.write(v5() ? bench.encode("REM_RobotCommand", {})
                   : bench.encode("REM_RobotCommand", {{"sendStateInfo", 1}}));
  bench.run_to(60 * kMs);
  EXPECT_EQ(bench.answers("REM_RobotAssuredAck").size(), 5u);
}

TEST_P(RemDongleTest, KillCoastsAndFollowsTheCommandInTheSameSlot) {
  Bench bench = make_bench({3});
  bench.write(bench.encode("REM_RobotKillCommand", {{"toRobotId", 3}}) + command(bench, 3, 1.0));
  bench.run_to(20 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  EXPECT_EQ(bench.sink.heard[0].message, "REM_RobotCommand");
  EXPECT_EQ(bench.sink.heard[1].message, "REM_RobotKillCommand");
  EXPECT_EQ(bench.sink.heard[1].command.mode, unsigned{OMNIHIL_MODE_COAST});
}

TEST_P(RemDongleTest, BroadcastReachesEveryRobotOfTheTeam) {
  Bench bench = make_bench({1, 6, 15});
  bench.write(bench.encode("REM_RobotCommand", {{"toBC", 1}, {"toRobotId", 9}, {"rho", 1.0}}));
  bench.run_to(30 * kMs);
  EXPECT_EQ(bench.good(), 1u);
  ASSERT_EQ(bench.sink.heard.size(), 3u);
  EXPECT_EQ(bench.sink.heard[0].robot, 1);
  EXPECT_EQ(bench.sink.heard[1].robot, 6);
  EXPECT_EQ(bench.sink.heard[2].robot, 15);
}

TEST_P(RemDongleTest, WrongColourAndAbsentRobotsAreAddressErrors) {
  Bench bench = make_bench({1}, Team::kBlue);
  bench.write(bench.encode("REM_RobotCommand", {{"toRobotId", 1}, {"toColor", 0}}));
  bench.write(bench.encode("REM_RobotCommand", {{"toRobotId", 2}, {"toColor", 1}}));
  bench.write(bench.encode("REM_BasestationGetConfiguration", {{"toRobotId", 1}, {"toColor", 1}}));
  bench.write(bench.encode("REM_RobotCommand", {{"toRobotId", 1}, {"toColor", 1}, {"toBS", 1}}));
  bench.run_to(40 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 4u);
  EXPECT_TRUE(bench.sink.heard.empty());
}

TEST_P(RemDongleTest, BaseStationTellsItsChannelAndAnotherChannelReachesNoRobot) {
  Bench bench = make_bench({1}, Team::kBlue);
  const auto ask = [&] {
    bench.to_host.clear();
    bench.write(bench.encode("REM_BasestationGetConfiguration", {{"toBS", 1}}));
    bench.run_to(bench.now_ns + 2 * kMs);
    const auto answers = bench.answers("REM_BasestationConfiguration");
    EXPECT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers.at(0).values.number("fromBS"), 1.0);
    EXPECT_EQ(answers.at(0).values.number("toPC"), 1.0);
    return answers.at(0).values.number("channel");
  };
  const Bytes blue = bench.encode("REM_RobotCommand", {{"toRobotId", 1}, {"toColor", 1}});
  EXPECT_EQ(ask(), 1.0);
  bench.write(bench.encode("REM_BasestationConfiguration", {{"toBS", 1}, {"channel", 0}}));
  EXPECT_EQ(ask(), 0.0);
  bench.write(blue);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  bench.write(bench.encode("REM_BasestationConfiguration", {{"toBS", 1}, {"channel", 1}}));
  bench.write(blue);
  bench.run_to(bench.now_ns + 20 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 1u);
}

TEST_P(RemDongleTest, WhatIsAddressedToThePcComesBackAsItWas) {
  Bench bench = make_bench({1});
  const Bytes packet = bench.encode("REM_Log", {{"toPC", 1}}, "hello");
  bench.write(packet);
  bench.step();
  EXPECT_EQ(bench.to_host, packet);
}

TEST_P(RemDongleTest, RobotsOwnPacketsFromTheHostAreRefused) {
  Bench bench = make_bench({1});
  for (const char* name :
       {"REM_RobotFeedback", "REM_RobotStateInfo", "REM_RobotPIDGains", "REM_RobotAssuredAck"}) {
    Values values;
    values.message = bench.format.find(name);
    Bytes packet;
    values.set("toRobotId", 1);
    for (const Field& field : values.message->fields) {
      if (field.lo > 0) values.set(field.name, field.lo);
    }
    ASSERT_EQ(bench.format.encode(values, packet).error, PacketError::kNone) << name;
    bench.write(packet);
  }
  bench.run_to(30 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kDirection), 4u);
  EXPECT_TRUE(bench.sink.heard.empty());
}

TEST_P(RemDongleTest, SoundsTextAndFillersAreAcceptedWithoutEffect) {
  Bench bench = make_bench({1});
  bench.write(bench.encode("REM_RobotBuzzer", {{"toRobotId", 1}}) +
              bench.encode("REM_RobotMusicCommand", {{"toRobotId", 1}, {"play", 1}}) +
              bench.encode("REM_Log", {{"toRobotId", 1}}, "text") + bench.encode("REM_SX1280Filler", {}) +
              bench.encode("REM_Packet", {{"toRobotId", 1}}));
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.good(), 5u);
  EXPECT_EQ(bench.link->from_host().refused(), 0u);
  EXPECT_TRUE(bench.sink.heard.empty());
}

TEST_P(RemDongleTest, FirmwareGetsItsPacketsAsBytesAndItsAnswersGoToTheHost) {
  Bench bench = make_bench({9}, Team::kYellow, true);
  bench.boot_robots();
  bench.step();
  const Bytes packet = command(bench, 9, 2.0);
  bench.write(packet);
  bench.run_to(20 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].kind, Delivery::Kind::kFrame);
  EXPECT_EQ(bench.sink.heard[0].frame, packet);
  EXPECT_TRUE(bench.to_host.empty());  // the link does not answer for it
  const Bytes answer = bench.encode("REM_Log", {{"toPC", 1}, {"fromRobotId", 9}}, "here");
  bench.link->robot_frame(9, answer, bench.now_ns);
  bench.link->robot_frame(9, packet, bench.now_ns);
  bench.link->robot_frame(9, Bytes{1, 2, 3}, bench.now_ns);
  bench.step();
  EXPECT_EQ(bench.to_host, answer);
  EXPECT_EQ(bench.link->from_robots().good, 1u);
  EXPECT_EQ(bench.link->from_robots().refused(), 2u);
}

TEST_P(RemDongleTest, BaseStationReportsOnceASecond) {
  Bench bench = make_bench({0});
  bench.run_to(3 * kS + 500 * kMs, 5 * kMs);
  const auto lines = bench.answers("REM_Log");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].values.number("fromBS"), 1.0);
  EXPECT_NEAR(lines[2].values.number("timestamp") * (v5() ? 10.0 : 1.0), 1.7e12 + 3000.0, 10.0);
}

TEST_P(RemDongleTest, DeliveriesDoNotDependOnHowOftenTheLinkIsPolled) {
  const auto run = [&](std::int64_t step_ns) {
    Bench bench = make_bench(all_ids());
    for (int i = 0; i < 50; ++i) {
      bench.write(command(bench, i % 16, 0.05 * i) +
                  bench.encode("REM_RobotSetPIDGains", {{"toRobotId", i % 3}, {"PbodyX", i % 40}}));
      bench.run_to(bench.now_ns + 10 * kMs, step_ns);
    }
    bench.run_to(bench.now_ns + 500 * kMs, step_ns);
    return bench.sink.heard;
  };
  const auto fine = run(50 * kUs);
  EXPECT_GT(fine.size(), 90u);
  EXPECT_TRUE(same(fine, run(1 * kMs)));
  EXPECT_TRUE(same(fine, run(10 * kMs)));
}

}  // namespace
}  // namespace omnihil
