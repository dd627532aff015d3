// Frames for several robots: Rhoban's lists, answered by a list; rocos' three places in one packet.
#include "protocols/packet_list.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

const RadioFormat& rhoban() { return *find_radio_format("rhoban-master-serial"); }

Values master(int robot, double x_speed_mm_s) {
  Values values;
  values.message = rhoban().find("master");
  values.set("robot", robot);
  values.set("actions", 1);
  values.set("x_speed", x_speed_mm_s);
  return values;
}

Bytes frame_of(std::initializer_list<Values> packets) {
  Bytes out;
  EXPECT_EQ(encode_list(rhoban(), std::vector<Values>(packets), out).error, PacketError::kNone);
  return out;
}

Bytes text(const char* line) { return Bytes(line, line + std::strlen(line)); }

TEST(ListDongle, RobotsHaveTheirTurnsAndOneListAnswers) {
  Bench bench(rhoban(), {.robot_ids = {1, 4}});
  bench.boot_robots();
  bench.robots[4].battery_V = 16.25;
  bench.step();
  bench.write(text("master\nmaster\nmaster\n") + frame_of({master(4, 500), master(1, -250)}));
  EXPECT_EQ(bench.link->from_host().refused(), 0u);
  bench.run_to(20 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  EXPECT_EQ(bench.sink.heard[0].robot, 4);
  EXPECT_EQ(bench.sink.heard[0].command.v_forward_m_s, 0.5);
  EXPECT_EQ(bench.sink.heard[1].robot, 1);
  EXPECT_EQ(bench.sink.heard[1].at_ns - bench.sink.heard[0].at_ns, 2 * kMs);
  ASSERT_EQ(listed_packets(rhoban(), bench.to_host), 2u);
  const Values first = decode_listed(rhoban(), bench.to_host, 0).values;
  EXPECT_EQ(first.number("robot"), 4.0);
  EXPECT_EQ(first.number("voltage_raw"), 130.0) << "8 times 16.25 V";
  EXPECT_EQ(decode_listed(rhoban(), bench.to_host, 1).values.number("id"), 1.0);
}

TEST(ListDongle, RobotsThatAreNotThereAreAbsentFromTheAnswer) {
  Bench bench(rhoban(), {.robot_ids = {1}});
  bench.boot_robots();
  bench.step();
  bench.write(frame_of({master(1, 1), master(5, 1)}));
  bench.run_to(20 * kMs);
  EXPECT_EQ(listed_packets(rhoban(), bench.to_host), 1u);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  bench.to_host.clear();
  bench.write(frame_of({master(5, 1)}));
  bench.run_to(40 * kMs);
  EXPECT_EQ(bench.to_host, frame_of({})) << "a list of none: the host waits for it";
}

TEST(ListDongle, AnEmptyListIsAnsweredByAnEmptyList) {
  Bench bench(rhoban(), {.robot_ids = {1}});
  bench.boot_robots();
  bench.step();
  bench.write(frame_of({}));
  bench.run_to(10 * kMs);
  EXPECT_EQ(bench.to_host, frame_of({}));
  EXPECT_TRUE(bench.sink.heard.empty());
}

TEST(ListDongle, ASecondListWaitsForTheFirst) {
  Bench bench(rhoban(), {.robot_ids = {0, 1}});
  bench.boot_robots();
  bench.step();
  bench.write(frame_of({master(0, 1), master(1, 2)}) + frame_of({master(0, 3)}));
  bench.run_to(20 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 3u);
  EXPECT_EQ(bench.sink.heard[2].at_ns - bench.sink.heard[0].at_ns, 4 * kMs);
  ASSERT_EQ(bench.to_host.size(), (4u + 22u) + (4u + 11u));
  EXPECT_EQ(listed_packets(rhoban(), std::span(bench.to_host).first(26)), 2u);
}

TEST(ListDongle, ABadPacketSpoilsItsListAndNotTheNext) {
  Bench bench(rhoban(), {.robot_ids = {1}});
  bench.boot_robots();
  Bytes bad = frame_of({master(1, 1), master(1, 2)});
  bad[3 + 17 + 1] = 9;  // no such instruction
  bench.write(bad + frame_of({master(1, 3)}));
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kUnknownType), 1u);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_NEAR(bench.sink.heard[0].command.v_forward_m_s, 0.003, 1e-12);
}

TEST(ListDongle, AKickBitActsWhenItComesAndNotWhileItStays) {
  Bench bench(rhoban(), {.robot_ids = {1}});
  std::vector<std::uint32_t> kicks;
  for (const double actions : {1.0, 5.0, 5.0, 1.0, 5.0, 3.0}) {  // on; flat; flat; on; flat; chip
    Values values = master(1, 0);
    values.set("actions", actions);
    values.set("kick_power", 100);
    bench.write(frame_of({values}));
    bench.run_to(bench.now_ns + 10 * kMs);
    kicks.push_back(bench.sink.heard.back().command.kick);
  }
  EXPECT_EQ(kicks, (std::vector<std::uint32_t>{OMNIHIL_KICK_NONE, OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_NONE,
                                               OMNIHIL_KICK_NONE, OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_CHIP}));
  EXPECT_NEAR(bench.sink.heard.back().command.kick_pulse_s, 3e-3, 1e-12) << "100 times 30 us";
}

TEST(PacketList, FaultsOfTheFrameHaveTheirCause) {
  const Bytes good = frame_of({master(1, 1), master(2, 2)});
  const auto fault = [](const Bytes& frame) { return decode_listed(rhoban(), frame, 0).error; };
  EXPECT_EQ(fault(good), PacketError::kNone);
  EXPECT_EQ(rhoban().decode(good).error, PacketError::kLength) << "decode is of a list of one";
  for (const std::size_t at : {std::size_t{0}, std::size_t{1}, good.size() - 1}) {
    Bytes bad = good;
    bad[at] ^= 0x10;
    EXPECT_EQ(fault(bad), PacketError::kFraming) << at;
  }
  Bytes nine = good;
  nine[2] = 9;
  EXPECT_EQ(fault(nine), PacketError::kLength);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(is_frame(rhoban(), std::span(good).first(size))) << size;
  }
  std::vector<Values> many(9, master(0, 0));
  Bytes out{7};
  EXPECT_EQ(encode_list(rhoban(), many, out).error, PacketError::kTooLong);
  EXPECT_EQ(out, Bytes{7});
}

constexpr const char* kRocos = "rocos-serial-25";

TEST(RocosDongle, ThreePlacesAreThoseOfTheRobotsAscending) {
  Bench bench(kRocos, {.robot_ids = {2, 7, 9}});
  bench.write(bench.encode("packets", {{"robots_15_to_8", 2},
                                       {"robots_7_to_0", 0x84},
                                       {"robot[0].present", 1},
                                       {"robot[0].vx", 100},
                                       {"robot[1].present", 1},
                                       {"robot[1].vy", 50},
                                       {"robot[1].vr", -80},
                                       {"robot[2].present", 1},
                                       {"robot[2].power", 127},
                                       {"robot[2].chip", 1}}));
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 3u);
  EXPECT_EQ(bench.sink.of_robot(2).at(0).command.v_forward_m_s, 1.0);
  EXPECT_EQ(bench.sink.of_robot(7).at(0).command.v_left_m_s, -0.5) << "y is to the right";
  EXPECT_EQ(bench.sink.of_robot(7).at(0).command.omega_body_rad_s, 2.0);
  EXPECT_EQ(bench.sink.of_robot(9).at(0).command.kick, unsigned{OMNIHIL_KICK_CHIP});
  EXPECT_NEAR(bench.sink.of_robot(9).at(0).command.v_kick_m_s, 6.5, 1e-9);
}

TEST(RocosDongle, StartPacketsAreAnsweredBy25Bytes) {
  Bench bench(kRocos, {.robot_ids = {2}});
  bench.write(bench.encode("start1", {}));
  bench.run_to(5 * kMs);
  EXPECT_EQ(bench.to_host.size(), 25u);
  bench.write(bench.encode("start2", {{"frequency", 6}}));
  bench.run_to(10 * kMs);
  EXPECT_EQ(bench.to_host.size(), 50u);
  EXPECT_EQ(bench.good(), 2u);
}

TEST(RocosDongle, AnswersComeOneByOne) {
  Bench bench(kRocos, {.robot_ids = {2, 7}});
  bench.boot_robots();
  bench.robots[7].flags = OMNIHIL_FEEDBACK_BALL_SEEN;
  bench.step();
  bench.write(
      bench.encode("packets", {{"robots_7_to_0", 0x84}, {"robot[0].present", 1}, {"robot[1].present", 1}}));
  std::size_t most = 0;
  for (int i = 0; i < 100; ++i) {
    const std::size_t before = bench.to_host.size();
    bench.run_to(bench.now_ns + 100 * kUs);
    most = std::max(most, bench.to_host.size() - before);
  }
  EXPECT_EQ(most, 25u);
  const auto answers = bench.answers("answer");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].values.number("number"), 2.0);
  EXPECT_FALSE(answers[0].values.flag("ball"));
  EXPECT_EQ(answers[1].values.number("number"), 7.0);
  EXPECT_TRUE(answers[1].values.flag("ball"));
}

}  // namespace
}  // namespace omnihil
