// Every field of the feedback says what is true of this firmware; what it cannot know is zero.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

bool has(const RobotFeedback& feedback, std::uint32_t flag) { return (feedback.flags & flag) != 0; }

TEST(Feedback, TimeAndCommandAgeCountFromTheLastCommand) {
  Bench bench(geared_robot());
  bench.run(10);
  bench.send_body(0, 0, 0);
  bench.run(43);
  const RobotFeedback feedback = bench.firmware->feedback();
  EXPECT_EQ(feedback.now_us, 52'000u);  // of the last tick
  EXPECT_EQ(feedback.command_age_ms, 42u);
  EXPECT_FALSE(has(feedback, OMNIHIL_FEEDBACK_COMMAND_TIMEOUT));
}

TEST(Feedback, SensorsPassThroughInTheirUnits) {
  Bench bench(geared_robot());
  RobotSensors sensors = bench.robot.sensors();
  sensors.accel_x_m_s2 = 1.25;
  sensors.accel_y_m_s2 = -2.5;
  sensors.gyro_z_rad_s = 0.75;
  sensors.ball_seen = 1;
  sensors.bus_voltage_V = 22.5;
  sensors.capacitor_V = 180.0;
  bench.firmware->tick(sensors);
  const RobotFeedback feedback = bench.firmware->feedback();
  EXPECT_EQ(feedback.accel_x_m_s2, 1.25);
  EXPECT_EQ(feedback.accel_y_m_s2, -2.5);
  EXPECT_EQ(feedback.body_derivative[3], 0.75);
  EXPECT_EQ(feedback.battery_V, 22.5);
  EXPECT_EQ(feedback.capacitor_V, 180.0);
  EXPECT_TRUE(has(feedback, OMNIHIL_FEEDBACK_BALL_SEEN));
  EXPECT_TRUE(has(feedback, OMNIHIL_FEEDBACK_IMU_READY));
  EXPECT_TRUE(has(feedback, OMNIHIL_FEEDBACK_BALL_SENSOR_OK));
}

TEST(Feedback, SensorsAreNotReadyBeforeTheFirstTick) {
  const RobotFeedback feedback = make_reference_firmware(geared_robot().config)->feedback();
  EXPECT_EQ(feedback.flags, static_cast<std::uint32_t>(OMNIHIL_FEEDBACK_COMMAND_TIMEOUT));
}

// A board whose tick comes late must still see the true speed: counts over the time that really passed.
TEST(Feedback, SpeedIsRightWhenTicksComeLate) {
  Bench bench(geared_robot());
  RobotSensors sensors{};
  sensors.bus_voltage_V = 24.0;
  for (int n = 0; n < 200; ++n) {
    const int period_us = n % 2 == 0 ? 1000 : 3000;
    sensors.now_us += static_cast<std::uint64_t>(period_us);
    for (auto& counts : sensors.encoder_counts) counts += 30 * period_us / 1000;
    bench.firmware->tick(sensors);
  }
  const double expected = 2 * std::numbers::pi * 30'000 / bench.config.encoder_counts_per_rotor_turn / 3.0;
  EXPECT_NEAR(bench.firmware->feedback().omega_wheel_rad_s[2], expected, 1e-3 * expected);
}

TEST(Feedback, YawIsTheIntegralOfTheGyroBetweenMinusAndPlusPi) {
  Bench bench(geared_robot());
  bench.run_with(body_command(0, 0, 5), 2000);
  const double wrapped_rad = std::remainder(bench.robot.yaw_rad, 2 * std::numbers::pi);
  EXPECT_NEAR(std::remainder(bench.firmware->feedback().yaw_rad - wrapped_rad, 2 * std::numbers::pi), 0.0,
              0.01);
  EXPECT_LE(std::abs(bench.firmware->feedback().yaw_rad), std::numbers::pi + 1e-6);
}

TEST(Feedback, TargetIsTheCommandAndOutputIsWhatIsAllowedOfItNow) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, -0.5, 2), 30);
  RobotFeedback feedback = bench.firmware->feedback();
  EXPECT_EQ(feedback.body_target[0], 1.0);
  EXPECT_EQ(feedback.body_target[1], -0.5);
  EXPECT_EQ(feedback.body_target[2], 2.0);
  EXPECT_GT(feedback.body_output[0], 0.0);
  EXPECT_LT(feedback.body_output[0], 0.2);  // 30 ms at 4 m/s^2 at most
  bench.run_with(body_command(1, -0.5, 2), 1000);
  feedback = bench.firmware->feedback();
  EXPECT_NEAR(feedback.body_output[0], 1.0, 1e-5);
  EXPECT_NEAR(feedback.body_output[1], -0.5, 1e-5);
  EXPECT_NEAR(feedback.body_output[2], 2.0, 1e-5);
}

TEST(Feedback, YawHoldReportsItsTargetAndWhatItAsksFor) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(0, 0, 0);
  command.flags = OMNIHIL_COMMAND_YAW_TARGET;
  command.yaw_target_rad = 0.5;
  bench.run_with(command, 1);
  const RobotFeedback feedback = bench.firmware->feedback();
  EXPECT_EQ(feedback.body_target[3], 0.5);
  EXPECT_NEAR(feedback.body_output[3], bench.firmware->gains().p[3] * 0.5, 1e-6);
}

TEST(Feedback, SlopesAreTheAccelerationsWhileSpeedingUp) {
  Bench bench(geared_robot());
  const RobotCommand command = body_command(2, 0, 0);
  bench.run_with(command, 100);
  const double before_m_s = bench.robot.body[0];
  bench.run_with(command, 200);
  const double slope_m_s2 = (bench.robot.body[0] - before_m_s) / 0.2;
  const RobotFeedback feedback = bench.firmware->feedback();
  EXPECT_NEAR(feedback.body_derivative[0], slope_m_s2, 0.1 * slope_m_s2);
  const double wheel = wheel_speed(bench.config, 0, {slope_m_s2, 0, 0});
  EXPECT_NEAR(feedback.wheel_accel_rad_s2[0], wheel, 0.1 * std::abs(wheel));
}

// At steady speed the integral carries what the feed-forward does not know: friction, i R with i = tau / k.
TEST(Feedback, WheelIntegralIsTheVoltageOfTheFriction) {
  const BenchRobotParams params = geared_robot();
  Bench bench(params);
  bench.run_with(body_command(0, 0, 6), 4000);
  const double omega_rotor = bench.robot.omega_rotor_rad_s[0];
  const double friction_Nm = params.coulomb_Nm + params.viscous_Nm_s_per_rad * omega_rotor;
  const double expected_V =
      friction_Nm / params.config.motor_torque_constant_Nm_per_A * params.config.motor_resistance_ohm;
  EXPECT_NEAR(bench.firmware->feedback().wheel_integral[0], expected_V, 0.1 * expected_V);
}

TEST(Feedback, WhatTheBoardCannotMeasureIsZero) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(1, 0, 0);
  command.flags = OMNIHIL_COMMAND_CHARGE;
  command.dribbler_ratio = 0.3;
  bench.run_with(command, 1200);
  const RobotFeedback feedback = bench.firmware->feedback();
  EXPECT_EQ(feedback.capacitor_V, 0.0);
  EXPECT_EQ(feedback.omega_dribbler_rad_s, 0.0);
  for (double integral : feedback.body_integral) EXPECT_EQ(integral, 0.0);
  EXPECT_FALSE(has(feedback, OMNIHIL_FEEDBACK_DRIBBLER_SEES_BALL));
  EXPECT_FALSE(has(feedback, OMNIHIL_FEEDBACK_KICKER_FAULT));
  EXPECT_TRUE(has(feedback, OMNIHIL_FEEDBACK_KICKER_ON));
  EXPECT_TRUE(has(feedback, OMNIHIL_FEEDBACK_CAPACITOR_CHARGED));
}

}  // namespace
}  // namespace omnihil::test
