// ibis: a datagram to one robot, its answer, and what its modes ask of the robot.
#include <cmath>

#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

constexpr const char* kId = "ibis-robot-command-v2";
constexpr double kCount = 1e-3;  // of speeds: 32.767 in 32767 counts

TEST(IbisDongle, ACommandReachesTheOneRobotAndIsAnswered) {
  Bench bench(kId, {.robot_ids = {3}});
  bench.robots[3].battery_V = 24.5;
  bench.robots[3].yaw_rad = M_PI / 2;
  bench.robots[3].v_forward_m_s = 1.0;
  bench.robots[3].omega_wheel_rad_s[2] = 4 * M_PI;
  bench.step();
  bench.write(bench.encode("SIMPLE_VELOCITY_TARGET", {{"check_counter", 42},
                                                      {"mode_args.target_global_vel[0]", 1.5},
                                                      {"mode_args.target_global_vel[1]", -0.5},
                                                      {"target_global_theta", 1.0}}));
  bench.run_to(1 * kMs);
  EXPECT_TRUE(bench.sink.heard.empty()) << "1 ms in the CM4, 72 bytes at 1 Mbaud";
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].at_ns, 1720 * kUs);
  const RobotCommand& command = bench.sink.heard[0].command;
  EXPECT_EQ(bench.sink.heard[0].robot, 3);
  EXPECT_EQ(command.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(command.flags, unsigned{OMNIHIL_COMMAND_FIELD_FRAME} | OMNIHIL_COMMAND_YAW_TARGET);
  EXPECT_NEAR(command.v_forward_m_s, 1.5, kCount);
  EXPECT_NEAR(command.v_left_m_s, -0.5, kCount);
  EXPECT_NEAR(command.yaw_target_rad, 1.0, kCount);
  const auto answers = bench.answers("FEEDBACK");
  ASSERT_EQ(answers.size(), 1u);
  const Values& feedback = answers[0].values;
  EXPECT_EQ(feedback.number("check_counter"), 42.0);
  EXPECT_EQ(feedback.number("checksum"), 10.0) << "the main board writes it in place of a sum";
  EXPECT_NEAR(feedback.number("imu_yaw_deg"), 90.0, 1e-4);
  EXPECT_NEAR(feedback.number("battery_voltage_bldc_right"), 24.5, 1e-6);
  EXPECT_NEAR(feedback.number("global_odom_speed_y"), 1.0, 1e-6) << "forward is along y";
  EXPECT_NEAR(feedback.number("tx_value_array[8]"), 2.0, 1e-6) << "revolutions per second";
}

TEST(IbisDongle, PolarVelocityIsSpeedAndDirection) {
  Bench bench(kId, {.robot_ids = {0}});
  bench.write(bench.encode("POLAR_VELOCITY_TARGET", {{"mode_args.target_global_velocity_r", 2.0},
                                                     {"mode_args.target_global_velocity_theta", M_PI / 2}}));
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_NEAR(bench.sink.heard[0].command.v_forward_m_s, 0.0, 3 * kCount);
  EXPECT_NEAR(bench.sink.heard[0].command.v_left_m_s, 2.0, 3 * kCount);
}

TEST(IbisDongle, EmergencyStopLetsTheWheelsRunFree) {
  Bench bench(kId, {.robot_ids = {0}});
  bench.write(bench.encode("LOCAL_CAMERA", {{"stop_emergency", 1}, {"mode_args.target_global_vel[0]", 1.0}}));
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].command.mode, unsigned{OMNIHIL_MODE_COAST});
}

TEST(IbisDongle, KickAndDribblerAreSharesOfFullStrength) {
  Bench bench(kId, {.robot_ids = {0}});
  bench.write(
      bench.encode("POSITION_TARGET", {{"kick_power", 0.5}, {"enable_chip", 1}, {"dribble_power", 0.25}}));
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  const RobotCommand& command = bench.sink.heard[0].command;
  EXPECT_EQ(command.kick, unsigned{OMNIHIL_KICK_CHIP});
  EXPECT_NEAR(command.v_kick_m_s, 3.25, 1e-6);
  EXPECT_NEAR(command.dribbler_ratio, 0.25, 1e-6);
  EXPECT_EQ(command.v_forward_m_s, 0.0) << "a place is nothing that the bench can hold";
}

TEST(IbisDongle, AHalfDatagramIsForgottenBeforeTheNext) {
  Bench bench(kId, {.robot_ids = {0}});
  const Bytes command = bench.encode("SIMPLE_VELOCITY_TARGET", {});
  bench.write(Bytes(command.begin(), command.begin() + 10));
  bench.run_to(8 * kMs);
  bench.write(command);
  bench.run_to(16 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kTooShort), 1u);
  EXPECT_EQ(bench.good(), 1u);
  EXPECT_EQ(bench.sink.heard.size(), 1u);
}

TEST(IbisDongle, WithTwoRobotsBehindItNobodyIsMeant) {
  Bench bench(kId, {.robot_ids = {0, 1}});
  bench.write(bench.encode("SIMPLE_VELOCITY_TARGET", {}));
  bench.run_to(10 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  EXPECT_TRUE(bench.sink.heard.empty());
}

}  // namespace
}  // namespace omnihil
