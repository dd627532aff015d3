// Each way of commanding a robot through command(), and what a bad command changes: nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

TEST(CommandModes, WheelSpeedsAreFollowedWheelByWheel) {
  Bench bench(geared_robot());
  bench.robot.lifted = true;  // four speeds that no body motion connects
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_WHEEL_SPEED;
  const double wanted[] = {20, -35, 5, 0};
  for (int w = 0; w < kWheels; ++w) command.omega_wheel_rad_s[w] = wanted[w];
  bench.run_with(command, 1000);
  for (int w = 0; w < kWheels; ++w) {
    EXPECT_NEAR(bench.robot.omega_wheel_rad_s(w), wanted[w], 0.02 * 35) << w;
    EXPECT_NEAR(bench.firmware->feedback().omega_wheel_target_rad_s[w], wanted[w], 1e-5) << w;
  }
}

// Straight on or sideways at 45 deg every wheel carries m a / (4 cos 45 deg): a = 0.55 g cos 45 deg.
TEST(CommandModes, AccelerationIsWhatTheTyresCanTransmit) {
  BenchRobotParams params = geared_robot();
  for (int w = 0; w < kWheels; ++w) params.config.wheel_angle_rad[w] = degrees(45 + 90 * w);
  const double expected_m_s2 = 0.55 * 9.81 * std::cos(degrees(45));
  for (const Body& direction : {Body{2, 0, 0}, Body{0, -2, 0}}) {
    Bench bench(params);
    bench.run_with(body_command(direction[0], direction[1], 0), 100);
    const RobotFeedback feedback = bench.firmware->feedback();
    EXPECT_NEAR(std::hypot(feedback.body_output[0], feedback.body_output[1]), expected_m_s2 * 0.1, 1e-3);
  }
  Bench diagonal(params);  // two wheels alone would have to push: 0.55 g / 2
  diagonal.run_with(body_command(2, 2, 0), 100);
  EXPECT_NEAR(diagonal.firmware->feedback().body_output[0] * std::sqrt(2.0), 0.55 * 9.81 / 2 * 0.1, 1e-3);
}

TEST(CommandModes, WheelDutyGoesStraightToTheBridges) {
  Bench bench(geared_robot());
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_WHEEL_DUTY;
  const double wanted[] = {1.0, -1.0, 0.125, 0.0};
  for (int w = 0; w < kWheels; ++w) command.duty_ratio[w] = wanted[w];
  bench.send(command);
  bench.tick();
  for (int w = 0; w < kWheels; ++w) {
    EXPECT_EQ(bench.drive.mode[w], static_cast<std::uint32_t>(OMNIHIL_DRIVE_DUTY));
    EXPECT_EQ(bench.drive.duty_ratio[w], wanted[w]);
    EXPECT_EQ(bench.firmware->feedback().duty_ratio[w], wanted[w]);
  }
}

TEST(CommandModes, ClosingTheLoopOnARollingRobotDoesNotJerk) {
  Bench bench(geared_robot());
  RobotCommand coast{};
  bench.run_with(body_command(1, 0, 0), 1000);
  bench.send(coast);
  bench.run(5);
  const double speed_m_s = bench.robot.body[0];
  ASSERT_GT(speed_m_s, 0.8);
  for (int n = 0; n < 100; ++n) {
    bench.run_with(body_command(speed_m_s, 0, 0), 1);
    ASSERT_NEAR(bench.robot.body[0], speed_m_s, 0.05) << n;
  }
}

TEST(CommandModes, FieldFrameVelocityKeepsItsDirectionWhileTheRobotTurns) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(0.5, 0.5, 4.0);
  command.flags = OMNIHIL_COMMAND_FIELD_FRAME;
  bench.run_with(command, 1000);
  double mean_x = 0, mean_y = 0;
  for (int n = 0; n < 1571; ++n) {  // one turn
    bench.run_with(command, 1);
    const double c = std::cos(bench.robot.yaw_rad), s = std::sin(bench.robot.yaw_rad);
    const double x = c * bench.robot.body[0] - s * bench.robot.body[1];
    const double y = s * bench.robot.body[0] + c * bench.robot.body[1];
    ASSERT_NEAR(x, 0.5, 0.03) << n;
    ASSERT_NEAR(y, 0.5, 0.03) << n;
    mean_x += x / 1571;
    mean_y += y / 1571;
  }
  EXPECT_NEAR(mean_x, 0.5, 0.01);
  EXPECT_NEAR(mean_y, 0.5, 0.01);
}

TEST(CommandModes, YawTargetIsReachedTheShortWayAndHeld) {
  for (const double target_deg : {90.0, -170.0, 170.0, 360.0 + 45.0}) {
    Bench bench(geared_robot());
    RobotCommand command = body_command(0, 0, 3.0);  // the rate is not used while a target is given
    command.flags = OMNIHIL_COMMAND_YAW_TARGET;
    command.yaw_target_rad = degrees(target_deg);
    const double expected_rad = std::remainder(degrees(target_deg), 2 * std::numbers::pi);
    double furthest_rad = 0;
    for (int n = 0; n < 2000; ++n) {
      bench.run_with(command, 1);
      furthest_rad = std::max(furthest_rad, std::abs(bench.robot.yaw_rad));
    }
    EXPECT_NEAR(bench.robot.yaw_rad, expected_rad, 0.01) << target_deg;
    EXPECT_LT(furthest_rad, std::abs(expected_rad) + 0.15) << target_deg;
    EXPECT_NEAR(bench.firmware->feedback().yaw_rad, expected_rad, 0.01) << target_deg;
  }
}

TEST(CommandModes, CameraYawSetsTheHeadingAndThenPullsIt) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(0, 0, 0);
  command.flags = OMNIHIL_COMMAND_CAMERA_YAW;
  command.camera_yaw_rad = 1.0;
  bench.send(command);
  bench.tick();
  EXPECT_NEAR(bench.firmware->feedback().yaw_rad, 1.0, 1e-6);
  command.camera_yaw_rad = 1.2;
  bench.send(command);
  bench.tick();
  EXPECT_NEAR(bench.firmware->feedback().yaw_rad, 1.0 + 0.05 * 0.2, 1e-6);
}

TEST(CommandModes, RebootForgetsEverythingButTheConfiguration) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, 0, 0), 300);
  RobotGains gains = bench.firmware->gains();
  gains.p[4] *= 2;
  ASSERT_TRUE(bench.firmware->set_gains(gains));
  RobotCommand reboot = body_command(1, 0, 0);
  reboot.flags = OMNIHIL_COMMAND_REBOOT;
  bench.send(reboot);
  bench.tick();
  EXPECT_TRUE(bench.coasting());
  EXPECT_EQ(bench.firmware->gains().p[4], gains.p[4] / 2);
  EXPECT_EQ(bench.firmware->feedback().flags & OMNIHIL_FEEDBACK_COMMAND_TIMEOUT,
            static_cast<std::uint32_t>(OMNIHIL_FEEDBACK_COMMAND_TIMEOUT));
  bench.run_with(body_command(1, 0, 0), 1500);
  EXPECT_NEAR(bench.robot.body[0], 1.0, 0.02);
}

TEST(CommandModes, KickSpeedBecomesAPulseAndMomentNowNeedsNoBall) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(0, 0, 0);
  command.flags = OMNIHIL_COMMAND_CHARGE;
  bench.run_with(command, 1100);
  command.kick = OMNIHIL_KICK_CHIP;
  command.kick_when = OMNIHIL_KICK_NOW;
  command.v_kick_m_s = 4.0;
  bench.send(command);
  bench.tick();
  EXPECT_EQ(bench.drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_CHIP));
  EXPECT_NEAR(bench.drive.kick_pulse_s, 4e-3, 1e-9);
}

TEST(CommandModes, KickAtYawWaitsForTheHeading) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(0, 0, 0);
  command.flags = OMNIHIL_COMMAND_CHARGE;
  bench.run_with(command, 1100);
  command.flags = OMNIHIL_COMMAND_YAW_TARGET;
  command.yaw_target_rad = 1.0;
  command.kick = OMNIHIL_KICK_STRAIGHT;
  command.kick_when = OMNIHIL_KICK_AT_YAW;
  command.kick_pulse_s = 2e-3;
  double yaw_at_kick_rad = -1;
  for (int n = 0; n < 2000 && yaw_at_kick_rad < 0; ++n) {
    bench.run_with(command, 1);
    if (bench.drive.kick != OMNIHIL_KICK_NONE) yaw_at_kick_rad = bench.robot.yaw_rad;
  }
  EXPECT_NEAR(yaw_at_kick_rad, 1.0, 0.035 + 0.01);
}

TEST(CommandModes, CommandWithoutKickDisarmsAWaitingKick) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(0, 0, 0);
  command.kick = OMNIHIL_KICK_STRAIGHT;
  command.kick_pulse_s = 2e-3;
  bench.run_with(command, 1100);  // charged, no ball
  bench.send(body_command(0, 0, 0));
  bench.robot.ball_seen = true;
  for (int n = 0; n < 50; ++n) {
    bench.tick();
    ASSERT_EQ(bench.drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_NONE));
  }
}

TEST(CommandModes, BadCommandChangesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::function<void(RobotCommand&)> spoil[] = {
      [](RobotCommand& c) { c.mode = 4; },
      [](RobotCommand& c) { c.kick = 3; },
      [](RobotCommand& c) { c.kick_when = 3; },
      [nan](RobotCommand& c) { c.v_forward_m_s = nan; },
      [nan](RobotCommand& c) { c.omega_body_rad_s = -1.0 / 0.0 + nan; },
      [nan](RobotCommand& c) { c.omega_wheel_rad_s[3] = nan; },
      [nan](RobotCommand& c) { c.duty_ratio[2] = nan; },
      [](RobotCommand& c) { c.duty_ratio[0] = 1.0000001; },
      [](RobotCommand& c) { c.duty_ratio[1] = -1.0000001; },
      [nan](RobotCommand& c) { c.yaw_target_rad = nan; },
      [](RobotCommand& c) { c.camera_yaw_rad = std::numeric_limits<double>::infinity(); },
      [](RobotCommand& c) { c.dribbler_ratio = 1.01; },
      [](RobotCommand& c) { c.dribbler_ratio = -0.01; },
      [](RobotCommand& c) { c.v_kick_m_s = -1.0; },
      [](RobotCommand& c) { c.kick_pulse_s = -1e-3; },
  };
  for (const auto& spoiled : spoil) {
    Bench touched(geared_robot()), untouched(geared_robot());
    touched.run_with(body_command(0.5, 0, 1), 50);
    untouched.run_with(body_command(0.5, 0, 1), 50);
    RobotCommand bad = body_command(-2, 1, 0);
    spoiled(bad);
    touched.send(bad);
    for (int n = 0; n < 100; ++n) {
      touched.tick();
      untouched.tick();
      for (int w = 0; w < kWheels; ++w) ASSERT_EQ(touched.drive.duty_ratio[w], untouched.drive.duty_ratio[w]);
    }
  }
}

TEST(Gains, AreGivenBackAsSetAlsoForLoopsThatDoNotExist) {
  Bench bench(geared_robot());
  RobotGains gains{};
  for (int loop = 0; loop < OMNIHIL_LOOPS; ++loop) {
    gains.p[loop] = 0.1 + loop;
    gains.i[loop] = 0.2 + loop;
    gains.d[loop] = 0.3 + loop;
    gains.d2[loop] = 0.4 + loop;
  }
  ASSERT_TRUE(bench.firmware->set_gains(gains));
  const RobotGains back = bench.firmware->gains();
  for (int loop = 0; loop < OMNIHIL_LOOPS; ++loop) {
    EXPECT_EQ(back.p[loop], gains.p[loop]);
    EXPECT_EQ(back.i[loop], gains.i[loop]);
    EXPECT_EQ(back.d[loop], gains.d[loop]);
    EXPECT_EQ(back.d2[loop], gains.d2[loop]);
  }
}

TEST(Gains, NegativeOrNotFiniteAreRefusedAndTheOldOnesStay) {
  Bench bench(geared_robot());
  const double before = bench.firmware->gains().p[4];
  for (const double bad : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity()}) {
    RobotGains gains = bench.firmware->gains();
    gains.i[0] = bad;
    gains.p[4] = 5.0;
    EXPECT_FALSE(bench.firmware->set_gains(gains));
    EXPECT_EQ(bench.firmware->gains().p[4], before);
  }
}

// duty = (k omega + p error) / bus at the first tick of a blocked wheel, the integral being still empty
TEST(Gains, WheelProportionalGainIsVoltsPerRotorSpeed) {
  Bench bench(geared_robot());
  bench.robot.blocked = true;
  RobotGains gains = bench.firmware->gains();
  gains.p[4] = 0.2;
  gains.i[4] = 0.0;
  ASSERT_TRUE(bench.firmware->set_gains(gains));
  bench.run_with(body_command(0, 0, 2), 500);
  const double omega_rotor = wheel_speed(bench.config, 0, {0, 0, 2}) * bench.config.gear_ratio;
  const double volts = bench.config.motor_torque_constant_Nm_per_A * omega_rotor + 0.2 * omega_rotor;
  EXPECT_NEAR(bench.drive.duty_ratio[0], volts / 24.0, 1e-5);
}

}  // namespace
}  // namespace omnihil::test
