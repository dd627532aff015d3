// What a ULaval robot makes of each packet.
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

struct HermesRobotTest : ::testing::Test {
  Bench bench{"ulaval-hermes", {.robot_ids = {1, 2}}};

  // Sends one packet to robot 1 and returns the commands it led to.
  std::vector<RobotCommand> send(const char* message, FieldValues fields, int robot = 1) {
    Values values;
    values.message = bench.format.find(message);
    values.set("robot", robot);
    for (const auto& [name, number] : fields) values.set(name, number);
    Bytes bytes;
    EXPECT_EQ(bench.format.encode(values, bytes).error, PacketError::kNone);
    bench.sink.heard.clear();
    bench.write(bytes);
    bench.run_to(bench.now_ns + 5 * kMs);
    std::vector<RobotCommand> commands;
    for (const Heard& heard : bench.sink.heard) commands.push_back(heard.command);
    return commands;
  }
};

TEST_F(HermesRobotTest, SpeedMoveIsABodyVelocity) {
  const auto commands = send("SPEED_MOVE", {{"vx", 1.5}, {"vy", -0.25}, {"vtheta", 3.0}});
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(commands[0].flags, 0u);
  EXPECT_EQ(commands[0].v_forward_m_s, 1.5);
  EXPECT_EQ(commands[0].v_left_m_s, -0.25);
  EXPECT_EQ(commands[0].omega_body_rad_s, 3.0);
  EXPECT_EQ(commands[0].kick, unsigned{OMNIHIL_KICK_NONE});
}

TEST_F(HermesRobotTest, AdvanceCarriesDribblerChargeAndKickTimeInTenthsOfAMillisecond) {
  const auto commands =
      send("SPEED_MOVE_ADVANCE", {{"vx", 1}, {"dribbler", 3}, {"charge", 1}, {"kick_force", 60}});
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].dribbler_ratio, 0.35);
  EXPECT_EQ(commands[0].flags, unsigned{OMNIHIL_COMMAND_CHARGE});
  EXPECT_EQ(commands[0].kick, unsigned{OMNIHIL_KICK_STRAIGHT});
  EXPECT_EQ(commands[0].kick_when, unsigned{OMNIHIL_KICK_ON_BALL});
  EXPECT_NEAR(commands[0].kick_pulse_s, 60 * 0.1e-3, 1e-15);
  EXPECT_EQ(commands[0].v_kick_m_s, 0.0);
}

TEST_F(HermesRobotTest, DribblerLevelsAreTheFirmwaresDuties) {
  const double expected[] = {0.0, 0.1, 0.2, 0.35, 0.0};
  for (int level = 0; level <= 4; ++level) {
    const auto commands = send("SPEED_MOVE_ADVANCE", {{"dribbler", level}});
    ASSERT_EQ(commands.size(), 1u);
    EXPECT_EQ(commands[0].dribbler_ratio, expected[level]) << level;
  }
}

TEST_F(HermesRobotTest, KickHappensOnceWhileChargeAndDribblerStay) {
  send("SPEED_MOVE_ADVANCE", {{"vx", 1}, {"dribbler", 1}, {"kick_force", 30}});
  const auto next = send("SPEED_MOVE", {{"vx", 1}});
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(next[0].kick, unsigned{OMNIHIL_KICK_NONE});
  EXPECT_EQ(next[0].kick_pulse_s, 0.0);
  EXPECT_EQ(next[0].flags, unsigned{OMNIHIL_COMMAND_CHARGE});  // a kick charges, too
  EXPECT_EQ(next[0].dribbler_ratio, 0.1);
}

TEST_F(HermesRobotTest, DutiesDriveOnlyWhileTheLoopIsOpen) {
  EXPECT_TRUE(send("OPEN_LOOP_COMMAND", {{"cmd[0]", 0.5}}).empty());
  send("SET_REGISTER", {{"register", 0}, {"value", 0}});
  const auto open =
      send("OPEN_LOOP_COMMAND", {{"cmd[0]", 0.5}, {"cmd[1]", -0.25}, {"cmd[2]", 2.0}, {"cmd[3]", -9}});
  ASSERT_EQ(open.size(), 1u);
  EXPECT_EQ(open[0].mode, unsigned{OMNIHIL_MODE_WHEEL_DUTY});
  EXPECT_EQ(open[0].duty_ratio[0], 0.5);
  EXPECT_EQ(open[0].duty_ratio[1], -0.25);
  EXPECT_EQ(open[0].duty_ratio[2], 1.0);
  EXPECT_EQ(open[0].duty_ratio[3], -1.0);
  EXPECT_TRUE(send("SPEED_MOVE", {{"vx", 1}}).empty());
  send("SET_REGISTER", {{"register", 0}, {"value", 2}});
  EXPECT_EQ(send("SPEED_MOVE", {{"vx", 1}}).size(), 1u);
}

TEST_F(HermesRobotTest, LoopStateBelongsToOneRobot) {
  send("SET_REGISTER", {{"register", 0}, {"value", 0}}, 1);
  EXPECT_TRUE(send("SPEED_MOVE", {{"vx", 1}}, 1).empty());
  EXPECT_EQ(send("SPEED_MOVE", {{"vx", 1}}, 2).size(), 1u);
}

TEST_F(HermesRobotTest, RegistersKickChargeAndDribble) {
  const auto kick = send("SET_REGISTER", {{"register", 1}, {"value", 5}});
  ASSERT_EQ(kick.size(), 1u);
  EXPECT_NEAR(kick[0].kick_pulse_s, 5e-3, 1e-15);  // the register counts in ms
  EXPECT_EQ(kick[0].kick, unsigned{OMNIHIL_KICK_STRAIGHT});
  const auto wrapped = send("SET_REGISTER", {{"register", 1}, {"value", 30}});
  EXPECT_NEAR(wrapped.at(0).kick_pulse_s, (300 - 256) * 0.1e-3, 1e-15);  // one byte of 0.1 ms
  const auto charge = send("SET_REGISTER", {{"register", 2}, {"value", 0}}, 2);
  EXPECT_EQ(charge.at(0).flags, unsigned{OMNIHIL_COMMAND_CHARGE});
  const auto dribble = send("SET_REGISTER", {{"register", 3}, {"value", 2}}, 2);
  EXPECT_EQ(dribble.at(0).dribbler_ratio, 0.2);
  EXPECT_EQ(dribble.at(0).flags, unsigned{OMNIHIL_COMMAND_CHARGE});
}

TEST_F(HermesRobotTest, RegisterDoesNotReviveASpeedThatTheRobotHasForgotten) {
  send("SPEED_MOVE", {{"vx", 1}});
  const auto soon = send("SET_REGISTER", {{"register", 3}, {"value", 1}});
  EXPECT_EQ(soon.at(0).v_forward_m_s, 1.0);
  bench.run_to(bench.now_ns + 500 * kMs);
  const auto late = send("SET_REGISTER", {{"register", 3}, {"value", 1}});
  EXPECT_EQ(late.at(0).v_forward_m_s, 0.0);
}

}  // namespace
}  // namespace omnihil
