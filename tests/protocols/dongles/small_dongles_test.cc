// What the small formats' robots do and answer: NAMeC's base station with its lists, RoboJackets' with its teams.
#include "protocols/packet_list.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

Bytes listed(const RadioFormat& format, const char* packet,
             const std::vector<std::map<std::string, double>>& rows) {
  std::vector<Values> values;
  for (const auto& row : rows) {
    Values& one = values.emplace_back();
    one.message = format.find(packet);
    for (const auto& [name, number] : row) one.set(name, number);
  }
  Bytes out;
  EXPECT_EQ(encode_list(format, values, out).error, PacketError::kNone);
  return out;
}

TEST(Namec, AFrameDrivesEachRobotAndOneFrameAnswersForAllThatAreThere) {
  Bench bench("namec-pc-to-base", {.robot_ids = {1, 5}});
  bench.boot_robots();
  bench.robots[1].omega_wheel_rad_s[3] = -12.5;
  bench.robots[1].battery_V = bench.robots[5].battery_V = 24.25;
  bench.robots[5].flags = OMNIHIL_FEEDBACK_BALL_SEEN;
  bench.step();
  bench.write(listed(
      bench.format, "BaseCommand",
      {{{"robot_id", 1}, {"normal_velocity", 1.25}, {"tangential_velocity", -0.5}, {"angular_velocity", 3.0}},
       {{"robot_id", 5}, {"kick", 2}, {"kick_power", 0.5}, {"charge", 1}, {"dribbler", 1.0}},
       {{"robot_id", 3}, {"normal_velocity", 9.0}}}));
  bench.run_to(20 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u) << "robot 3 is not there";
  const RobotCommand first = bench.sink.of_robot(1).at(0).command;
  EXPECT_EQ(first.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(first.flags, 0u);
  EXPECT_EQ(first.v_forward_m_s, 1.25);
  EXPECT_EQ(first.v_left_m_s, -0.5);
  EXPECT_EQ(first.omega_body_rad_s, 3.0);
  const RobotCommand second = bench.sink.of_robot(5).at(0).command;
  EXPECT_EQ(second.flags, unsigned{OMNIHIL_COMMAND_CHARGE});
  EXPECT_EQ(second.kick, unsigned{OMNIHIL_KICK_CHIP});
  EXPECT_EQ(second.kick_when, unsigned{OMNIHIL_KICK_NOW});
  EXPECT_NEAR(second.v_kick_m_s, 3.25, 1e-6);
  EXPECT_EQ(second.dribbler_ratio, 1.0);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  ASSERT_EQ(listed_packets(bench.format, bench.to_host), 2u);
  const Values one = decode_listed(bench.format, bench.to_host, 0).values;
  const Values two = decode_listed(bench.format, bench.to_host, 1).values;
  EXPECT_EQ(one.message->name, "BaseFeedback");
  EXPECT_EQ(one.number("robot_id"), 1.0);
  EXPECT_EQ(one.number("motor_4_speed"), -12.5);
  EXPECT_EQ(two.number("ir"), 1.0);
  EXPECT_EQ(two.number("voltage"), 24.25);
}

TEST(Namec, NobodysFrameIsTakenWithoutAnswerAndTheNextIsFound) {
  Bench bench("namec-pc-to-base", {.robot_ids = {1}});
  bench.boot_robots();
  bench.step();
  bench.write(Bytes{0, 0} + bench.encode("BaseCommand", {{"robot_id", 1}, {"normal_velocity", 1.0}}));
  bench.run_to(10 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.good(), 1u);
  EXPECT_EQ(listed_packets(bench.format, bench.to_host), 1u);
}

TEST(RoboJackets, XIsToTheRightAndTheAnswerSaysWhatTheRobotIs) {
  Bench bench("robojackets-2024", {.robot_ids = {6}, .team = Team::kBlue});
  bench.boot_robots();
  bench.robots[6].battery_V = 20.0;
  bench.robots[6].flags = OMNIHIL_FEEDBACK_CAPACITOR_CHARGED;
  bench.step();
  bench.write(bench.encode("control_message", {{"robot_id", 6},
                                               {"body_x", 0.5},
                                               {"body_y", 1.25},
                                               {"body_w", -2.0},
                                               {"trigger_mode", 2},
                                               {"kick_strength", 255},
                                               {"dribbler_speed", 50}}));
  bench.run_to(5 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  const RobotCommand& command = bench.sink.heard[0].command;
  EXPECT_NEAR(command.v_forward_m_s, 1.25, 1e-3);
  EXPECT_NEAR(command.v_left_m_s, -0.5, 1e-3);
  EXPECT_NEAR(command.omega_body_rad_s, -2.0, 1e-3);
  EXPECT_EQ(command.kick, unsigned{OMNIHIL_KICK_STRAIGHT});
  EXPECT_EQ(command.kick_when, unsigned{OMNIHIL_KICK_ON_BALL});
  EXPECT_EQ(command.v_kick_m_s, 7.0);
  EXPECT_EQ(command.dribbler_ratio, 0.5);
  // Team 0 is blue; robot 6; charged, healthy; 20 V are 202 counts of 0.09884 V.
  EXPECT_EQ(bench.to_host, (Bytes{6 << 3 | 0b011, 202, 0}));
}

TEST(RoboJackets, TheOtherTeamsPacketsAndTestsDriveNobody) {
  Bench bench("robojackets-2024", {.robot_ids = {6}, .team = Team::kBlue});
  bench.boot_robots();
  bench.step();
  bench.write(bench.encode("control_message", {{"robot_id", 6}, {"team", 1}, {"body_y", 1.0}}));
  bench.write(bench.encode("control_message", {{"robot_id", 6}, {"mode", 2}, {"body_y", 1.0}}));
  bench.run_to(5 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].command.mode, unsigned{OMNIHIL_MODE_COAST});
}

}  // namespace
}  // namespace omnihil
