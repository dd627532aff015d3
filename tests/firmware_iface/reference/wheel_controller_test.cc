// One wheel's law, term by term, and what it plans ahead.
#include "firmware_iface/reference/wheel_controller.h"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware_iface/reference/kicker.h"
#include "firmware_iface/reference/motion_reference.h"
#include "firmware_iface/reference/wheel_tuning.h"
#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

constexpr motor_constants kMotor{.resistance_ohm = 1.0f, .torque_constant_Nm_per_A = 0.03f};
constexpr wheel_gains kGains{.p_V_s_per_rad = 0.1f, .i_V_per_rad = 2.0f, .d_V_s2_per_rad = 0.001f};

wheel_loop_input input(float wanted, float measured) {
  return {.omega_ref_rad_s = wanted,
          .omega_rad_s = measured,
          .accel_rad_s2 = 0.0f,
          .torque_feedforward_Nm = 0.0f,
          .bus_V = 24.0f,
          .dt_s = 1e-3f};
}

TEST(WheelLoop, VoltageIsTheSumOfItsTerms) {
  wheel_loop loop{};
  wheel_loop_input in = input(100.0f, 90.0f);
  in.torque_feedforward_Nm = 0.06f;
  in.accel_rad_s2 = 50.0f;
  // k omega_ref + R tau / k + p e + i e dt - d a
  const double volts = 0.03 * 100 + 1.0 * 0.06 / 0.03 + 0.1 * 10 + 2.0 * 10 * 1e-3 - 0.001 * 50;
  EXPECT_NEAR(wheel_loop_update(&loop, &kGains, &kMotor, &in), volts / 24.0, 1e-6);
  EXPECT_NEAR(loop.integral_V, 2.0 * 10 * 1e-3, 1e-7);
}

TEST(WheelLoop, IntegralStandsStillWhileTheDutyIsAtItsLimitAndUnwindsFreely) {
  wheel_loop loop{};
  const wheel_loop_input held = input(500.0f, 0.0f);  // 0.03 * 500 + 0.1 * 500 = 65 V wanted, 24 V there
  for (int n = 0; n < 5000; ++n) wheel_loop_update(&loop, &kGains, &kMotor, &held);
  EXPECT_EQ(loop.duty_ratio, 1.0f);
  EXPECT_EQ(loop.integral_V, 0.0f);
  loop.integral_V = 5.0f;
  const wheel_loop_input too_fast = input(500.0f, 600.0f);
  wheel_loop_update(&loop, &kGains, &kMotor, &too_fast);
  EXPECT_NEAR(loop.integral_V, 5.0 - 2.0 * 100 * 1e-3, 1e-5);
}

TEST(WheelLoop, IntegralFillsToHalfOfTheSupplyAndNoFurther) {
  wheel_loop loop{};
  const wheel_loop_input slow = input(10.0f, 0.0f);  // 0.03 * 10 + 0.1 * 10 + 12 V: below the 24 V there
  for (int n = 0; n < 2000; ++n) wheel_loop_update(&loop, &kGains, &kMotor, &slow);
  EXPECT_EQ(loop.integral_V, 12.0f);
  EXPECT_NEAR(loop.duty_ratio, (0.03 * 10 + 0.1 * 10 + 12.0) / 24.0, 1e-6);
}

TEST(WheelLoop, LimitsAreAlikeInBothDirections) {
  wheel_loop loop{};
  const wheel_loop_input held = input(-500.0f, 0.0f);
  for (int n = 0; n < 100; ++n) wheel_loop_update(&loop, &kGains, &kMotor, &held);
  EXPECT_EQ(loop.duty_ratio, -1.0f);
  EXPECT_EQ(loop.integral_V, 0.0f);
}

// The rule of wheel_tuning.h: critically damped when loaded, bandwidth at most 40 rad/s.
TEST(WheelTuning, LoadedLoopIsCriticallyDampedAndNotFasterThanAsked) {
  for (const BenchRobotParams& robot : {geared_robot(), direct_robot()}) {
    wheel_tuning tuning{};
    wheel_tuning_init(&tuning, &robot.config, 1e-3f);
    const double k = robot.config.motor_torque_constant_Nm_per_A,
                 resistance = robot.config.motor_resistance_ohm;
    const double radius = robot.config.wheel_radius_m, gear = robot.config.gear_ratio;
    const double inertia = tuning.inertia_free_kg_m2 + tuning.mass_kg * radius * radius / (2 * gear * gear);
    const double bandwidth = (tuning.gains.p_V_s_per_rad + k) * k / (inertia * resistance);
    EXPECT_LE(bandwidth, 40.01);
    EXPECT_GT(bandwidth, 8.0);
    // s^2 + b s + i k / (J R): double root at b^2 / 4
    EXPECT_NEAR(tuning.gains.i_V_per_rad * k / (inertia * resistance), bandwidth * bandwidth / 4,
                1e-3 * bandwidth * bandwidth);
  }
}

TEST(MotionReference, SteadyCircleNeedsTheCentripetalForce) {
  const RobotConfig config = geared_robot().config;
  wheel_geometry geometry{};
  ASSERT_EQ(wheel_geometry_init(&geometry, &config), 0);
  motion_reference motion{};
  motion.wheel_limit_rad_s = 1000.0f;
  const float target[] = {1.0f, 0.5f, 3.0f};
  for (int n = 0; n < 2000; ++n) motion_toward_body(&motion, &geometry, target, 1e-3f);
  // a = omega x v
  EXPECT_NEAR(motion.body_accel[0], -3.0 * 0.5, 1e-3);
  EXPECT_NEAR(motion.body_accel[1], 3.0 * 1.0, 1e-3);
  EXPECT_NEAR(motion.body_accel[2], 0.0, 1e-3);
}

TEST(MotionReference, VelocityFixedInTheFieldNeedsNoForceWhileTheBodyTurns) {
  const RobotConfig config = geared_robot().config;
  wheel_geometry geometry{};
  ASSERT_EQ(wheel_geometry_init(&geometry, &config), 0);
  motion_reference motion{};
  motion.wheel_limit_rad_s = 1000.0f;
  const float dt_s = 1e-3f, omega = 3.0f;
  for (int n = 0; n < 3000; ++n) {
    const float yaw = omega * dt_s * static_cast<float>(n);
    const float target[] = {std::cos(yaw), -std::sin(yaw), omega};
    motion_turn_under(&motion, omega * dt_s);
    motion_toward_body(&motion, &geometry, target, dt_s);
  }
  EXPECT_NEAR(std::hypot(motion.body[0], motion.body[1]), 1.0, 1e-3);
  EXPECT_NEAR(motion.body_accel[0], 0.0, 0.02);
  EXPECT_NEAR(motion.body_accel[1], 0.0, 0.02);
}

TEST(Kicker, SecondKickNeedsAnotherSecondOfCharging) {
  kicker k{};
  int kicks = 0, first_ms = 0, second_ms = 0;
  for (int n = 0; n < 2500; ++n) {
    const auto now_us = static_cast<std::uint64_t>(n) * 1000u;
    kicker_arm(&k, OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_NOW, 1e-3f, now_us + 1000000u);  // asked all the time
    if (kicker_update(&k, now_us, 1e-3f, 0, 0.0f).kick == OMNIHIL_KICK_NONE) continue;
    (++kicks == 1 ? first_ms : second_ms) = n;
  }
  EXPECT_EQ(kicks, 2);
  EXPECT_NEAR(first_ms, 1000, 2);
  EXPECT_NEAR(second_ms - first_ms, 1000, 2);
}

}  // namespace
}  // namespace omnihil::test
