// What the small formats' robots do and answer: NAMeC's base station with its lists, RoboJackets' with its teams and the
// robots before it with none, ibis' datagram for all, rocos by UDP.
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

TEST(RoboJackets2023, ARobotTellsOfItselfUnaskedAndTakesCommands) {
  Bench bench("robojackets-2023", {.robot_ids = {3}});
  bench.boot_robots();
  bench.robots[3].battery_V = 20.0;
  bench.robots[3].flags = OMNIHIL_FEEDBACK_BALL_SEEN | OMNIHIL_FEEDBACK_CAPACITOR_CHARGED;
  bench.run_to(1'000 * kMs);
  const auto told = bench.answers("RobotStatusMessage");
  EXPECT_EQ(told.size(), 91u) << "one each 11 ms, at 0 to 990 ms";
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told[0].values.number("uid"), 3.0);
  EXPECT_EQ(told[0].values.number("battVoltage"), 202.0) << "of 0.09884 V";
  EXPECT_EQ(told[0].values.number("ballSenseStatus"), 1.0);
  EXPECT_EQ(told[0].values.number("kickStatus"), 1.0);
  EXPECT_EQ(told[0].values.number("fpgaStatus"), 0.0);
  bench.write(bench.encode("ControlMessage", {{"uid", 3},
                                              {"bodyX", 0.5},
                                              {"bodyY", 1.25},
                                              {"bodyW", -2.0},
                                              {"dribbler", -128},
                                              {"triggerMode", 1},
                                              {"shootMode", 1},
                                              {"kickStrength", 255}}));
  bench.run_to(1'005 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  const RobotCommand& command = bench.sink.heard[0].command;
  EXPECT_NEAR(command.v_forward_m_s, 1.25, 1e-3);
  EXPECT_NEAR(command.v_left_m_s, -0.5, 1e-3);
  EXPECT_NEAR(command.omega_body_rad_s, -2.0, 1e-3);
  EXPECT_EQ(command.dribbler_ratio, 1.0) << "80h without sign is full speed";
  EXPECT_EQ(command.kick, unsigned{OMNIHIL_KICK_CHIP});
  EXPECT_EQ(command.kick_when, unsigned{OMNIHIL_KICK_NOW});
  EXPECT_EQ(command.v_kick_m_s, 7.0);
}

TEST(RoboJackets2023, AHostsKickComesBackWithinAStepAndBelowTheLeastIsNotSaid) {
  const RadioFormat& format = *find_radio_format("robojackets-2023");
  for (const std::uint32_t kind : {OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_CHIP}) {
    RobotCommand kick{};
    kick.mode = OMNIHIL_MODE_BODY_VELOCITY;
    kick.kick = kind, kick.kick_when = OMNIHIL_KICK_ON_BALL, kick.v_kick_m_s = 3.0;
    Bench bench(format, {.robot_ids = {5}});
    Bytes bytes;
    ASSERT_TRUE(format.encode_command(kick, {.robot_id = 5}, bytes));
    bench.write(bytes);
    bench.run_to(5 * kMs);
    ASSERT_EQ(bench.sink.heard.size(), 1u);
    EXPECT_EQ(bench.sink.heard[0].command.kick, kind);
    EXPECT_EQ(bench.sink.heard[0].command.kick_when, unsigned{OMNIHIL_KICK_ON_BALL});
    EXPECT_NEAR(bench.sink.heard[0].command.v_kick_m_s, 3.0, 6.5 / 255.0);
    kick.v_kick_m_s = 0.4;  // strength 0 is faster
    EXPECT_FALSE(format.encode_command(kick, {.robot_id = 5}, bytes));
  }
}

TEST(IbisBroadcast, EachRobotTakesItsPlaceOfTheDatagramAndAnswers) {
  Bench bench("ibis-broadcast-715", {.robot_ids = {2, 7}});
  bench.boot_robots();
  bench.step();
  Bytes datagram;
  for (int robot = 10; robot >= 0; --robot)
    datagram =
        datagram + bench.encode("SIMPLE_VELOCITY_TARGET", {{"robot_id", robot},
                                                           {"check_counter", 10.0 + robot},
                                                           {"mode_args.target_global_vel[0]", 0.1 * robot}});
  ASSERT_EQ(datagram.size(), 715u);
  bench.write(datagram);
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  EXPECT_NEAR(bench.sink.of_robot(2).at(0).command.v_forward_m_s, 0.2, 1e-3);
  EXPECT_NEAR(bench.sink.of_robot(7).at(0).command.v_forward_m_s, 0.7, 1e-3);
  EXPECT_EQ(bench.link->from_host().refused(), 0u) << "places of others are no faults";
  const auto answers = bench.answers("FEEDBACK");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].values.number("check_counter"), 17.0) << "in the order of the places";
  EXPECT_EQ(answers[1].values.number("check_counter"), 12.0);
}

TEST(IbisBroadcast, AHostsCommandIsAWholeDatagramThatMeansOneRobot) {
  const RadioFormat& format = *find_radio_format("ibis-broadcast-715");
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.flags = OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET;
  command.v_forward_m_s = 1.0;
  Bytes bytes;
  ASSERT_TRUE(format.encode_command(command, {.robot_id = 4}, bytes));
  EXPECT_EQ(bytes.size(), 715u);
  int places[256] = {};
  for (std::size_t at = 0; at < bytes.size(); at += 65) ++places[bytes[at]];
  EXPECT_EQ(places[4], 1);
  EXPECT_EQ(places[255], 10);
  EXPECT_FALSE(format.encode_command(command, {.robot_id = 255}, bytes));
}

TEST(RocosUdp, FourRobotsInOnePacketMoveByTheirTwoPartSpeeds) {
  Bench bench("rocos-udp", {.robot_ids = {3, 12}});
  bench.boot_robots();
  bench.robots[3].battery_V = 16.8, bench.robots[3].capacitor_V = 200.0;
  bench.robots[3].flags = OMNIHIL_FEEDBACK_BALL_SEEN;
  bench.step();
  // 300 = 2 * 128 + 44 cm/s backward, 140 = 128 + 12 cm/s left, 2047 = 15 * 128 + 127 counts clockwise.
  bench.write(bench.encode("packets", {{"robot[0].present", 1},
                                       {"robot[0].id", 3},
                                       {"robot[0].vx_sign", 1},
                                       {"robot[0].vx_low", 44},
                                       {"robot[0].vx_high", 2},
                                       {"robot[0].vy_low", 12},
                                       {"robot[0].vy_high", 1},
                                       {"robot[0].vr_sign", 1},
                                       {"robot[0].vr_low", 127},
                                       {"robot[0].vr_high", 15},
                                       {"robot[0].dribble", 1.0 / 3.0},
                                       {"robot[3].present", 1},
                                       {"robot[3].id", 12},
                                       {"robot[3].chip", 1},
                                       {"robot[3].power", 127}}));
  bench.run_to(5 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  const RobotCommand first = bench.sink.of_robot(3).at(0).command;
  EXPECT_DOUBLE_EQ(first.v_forward_m_s, -3.0);
  EXPECT_DOUBLE_EQ(first.v_left_m_s, 1.4);
  EXPECT_DOUBLE_EQ(first.omega_body_rad_s, -2047.0 / 160.0);
  EXPECT_NEAR(first.dribbler_ratio, 1.0 / 3.0, 1e-9);
  EXPECT_EQ(first.kick, unsigned{OMNIHIL_KICK_NONE});
  const RobotCommand second = bench.sink.of_robot(12).at(0).command;
  EXPECT_EQ(second.kick, unsigned{OMNIHIL_KICK_CHIP});
  EXPECT_DOUBLE_EQ(second.v_kick_m_s, 6.5);
  const auto answers = bench.answers("answer");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].values.number("number"), 4.0) << "the robot + 1";
  EXPECT_EQ(answers[0].values.number("infrared"), 1.0);
  EXPECT_EQ(answers[0].values.number("battery"), 224.0) << "full";
  EXPECT_EQ(answers[0].values.number("capacitance"), 200.0);
}

TEST(RocosUdp, StartsAreTakenWithoutAnswerAndAPlaceWithoutRobotMovesNobody) {
  Bench bench("rocos-udp", {.robot_ids = {0}});
  bench.boot_robots();
  bench.step();
  bench.write(bench.encode("start_transmitter", {{"channel", 0x5A}, {"channel_again", 0x5A}}));
  bench.write(bench.encode("start_receiver", {{"channel", 0x5A}, {"channel_again", 0x5A}}));
  bench.write(bench.encode("packets", {{"robot[0].vx_low", 100}}));  // of robot 0, but no place is taken
  bench.run_to(10 * kMs);
  EXPECT_EQ(bench.good(), 3u);
  EXPECT_TRUE(bench.sink.heard.empty());
  EXPECT_TRUE(bench.to_host.empty());
}

}  // namespace
}  // namespace omnihil
