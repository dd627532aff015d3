// TIGERs: one base station for all robots, a datagram for each.
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

constexpr const char* kId = "tigers-base-station";

TEST(TigersDongle, SkillsReachTheirRobotsAndAreAnswered) {
  Bench bench(kId, {.robot_ids = {2, 11}});
  bench.boot_robots();
  bench.robots[11].battery_V = 23.4;
  bench.robots[11].yaw_rad = 0.5;
  bench.step();
  bench.write(
      bench.encode("auth", {}) +
      bench.encode("local_vel", {{"bot", 11}, {"skill_in.xyw[0]", 1500}, {"skill_in.xyw[2]", -250}}) +
      bench.encode(
          "global_vel",
          {{"bot", 2}, {"skill_in.xyw[1]", 500}, {"skill_in.kickMode", 1}, {"skill_in.kickSpeed", 4.0}}));
  bench.run_to(5 * kMs);
  EXPECT_EQ(bench.good(), 3u);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  const RobotCommand local = bench.sink.of_robot(11).at(0).command;
  EXPECT_EQ(local.v_forward_m_s, 1.5);
  EXPECT_EQ(local.omega_body_rad_s, -0.25);
  EXPECT_EQ(local.flags, 0u);
  const RobotCommand global = bench.sink.of_robot(2).at(0).command;
  EXPECT_EQ(global.v_left_m_s, 0.5);
  EXPECT_EQ(global.flags, unsigned{OMNIHIL_COMMAND_FIELD_FRAME});
  EXPECT_EQ(global.kick, unsigned{OMNIHIL_KICK_STRAIGHT});
  EXPECT_NEAR(global.v_kick_m_s, 4.0, 1e-9);
  const auto answers = bench.answers("match_feedback");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].values.number("bot"), 11.0);
  EXPECT_EQ(answers[0].values.number("batteryLevel"), 234.0);
  EXPECT_EQ(answers[0].values.number("curPosition[2]"), 500.0);
}

TEST(TigersDongle, WheelsAndEmergency) {
  Bench bench(kId, {.robot_ids = {2}});
  bench.write(bench.encode("wheel_vel", {{"bot", 2}, {"skill_in.wheel[3]", -2000}}) +
              bench.encode("emergency", {{"bot", 2}}) +
              bench.encode("global_pos", {{"bot", 2}, {"skill_in.xyw[0]", 1}}));
  bench.run_to(5 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 3u);
  EXPECT_EQ(bench.sink.heard[0].command.mode, unsigned{OMNIHIL_MODE_WHEEL_SPEED});
  EXPECT_NEAR(bench.sink.heard[0].command.omega_wheel_rad_s[3], -10.0, 1e-12);
  EXPECT_EQ(bench.sink.heard[1].command.mode, unsigned{OMNIHIL_MODE_COAST});
  EXPECT_EQ(bench.sink.heard[2].command.v_forward_m_s, 0.0);
}

TEST(TigersDongle, PingComesBackAndStrangersAreCounted) {
  Bench bench(kId, {.robot_ids = {2}});
  bench.write(bench.encode("ping", {}) + bench.encode("emergency", {{"bot", 5}}) + Bytes{0x99, 0x98});
  bench.write(bench.encode("match_feedback", {{"bot", 2}}));
  bench.run_to(5 * kMs);
  EXPECT_EQ(bench.to_host, Bytes{0x61});
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  EXPECT_EQ(bench.refused(PacketError::kFraming), 1u);
  EXPECT_EQ(bench.refused(PacketError::kDirection), 1u);
}

}  // namespace
}  // namespace omnihil
