#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double level_at(double omega_rad_s, std::vector<double> params) {
  TorquePort<double> port;
  port.omega_rotor_rad_s = omega_rad_s;
  find_effect("stribeck_friction")->simulate.torque(nullptr, params.data(), nullptr, port);
  EXPECT_EQ(port.friction_positive_Nm, port.friction_negative_Nm);
  return port.friction_positive_Nm;
}

TEST(StribeckFriction, HasFallenByTheBellCurveAtItsSpeed) {
  EXPECT_DOUBLE_EQ(level_at(0.0, {0.002, 5.0, 2.0}), 0.002);
  EXPECT_NEAR(level_at(5.0, {0.002, 5.0, 2.0}), 0.002 * std::exp(-1.0), 1e-15);
  EXPECT_NEAR(level_at(-10.0, {0.002, 5.0, 2.0}), 0.002 * std::exp(-4.0), 1e-15);
  EXPECT_NEAR(level_at(10.0, {0.002, 5.0, 0.5}), 0.002 * std::exp(-std::sqrt(2.0)), 1e-15);
}

TEST(StribeckFriction, VanishesFarAboveItsSpeed) {
  EXPECT_EQ(level_at(100.0, {0.002, 5.0, 2.0}), 0.0);
  const AxisInput in = held(CommandKind::kDuty, 0.6, 2.0);
  const auto without = run_axis(small_drive(), nothing(), in).back();
  const auto with_it = run_axis(small_drive(), with({use_of("stribeck_friction", {0.002, 5.0})}), in).back();
  EXPECT_NEAR(with_it.omega_rotor_rad_s, without.omega_rotor_rad_s, 1e-9);
}

// The speed between rest and sliding does not matter for what it takes to break away.
TEST(StribeckFriction, AddsToWhatHoldsTheRotor) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.003;
  const double k = p.torque_constant_Nm_per_A;
  const auto effects = with({use_of("stribeck_friction", {0.002, 5.0})});
  EXPECT_TRUE(run_axis(p, effects, held(CommandKind::kMotorCurrent, 0.00499 / k, 0.1)).back().held);
  EXPECT_FALSE(run_axis(p, effects, held(CommandKind::kMotorCurrent, 0.00501 / k, 0.1)).back().held);
}

// Signature: turned at held slow speeds, the bench's torque falls from rest to a few times its speed.
TEST(StribeckFriction, ShowsAsATorqueThatFallsWithSpeed) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.003;
  for (const double speed : {0.5, 3.0, 6.0, 20.0}) {
    for (const double sign : {1.0, -1.0}) {
      AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.2);
      in.imposed_velocity_rad_s.assign(in.time_s.size(), sign * speed);
      const auto out = run_axis(p, with({use_of("stribeck_friction", {0.002, 5.0})}), in).back();
      const double friction = 0.003 + 0.002 * std::exp(-speed * speed / 25.0);
      EXPECT_NEAR(out.load_torque_Nm, sign * (friction + p.viscous_friction_Nm_s_per_rad * speed), 1e-12);
    }
  }
}

// Signature: pulled by a soft spring it sticks and slips; with Coulomb friction alone it glides.
TEST(StribeckFriction, ShowsAsStickSlipUnderASoftServo) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.003;
  p.servo_kp_duty_per_rad = 0.2;
  p.servo_duty_limit_ratio = 1.0;
  AxisInput in = held(CommandKind::kPositionTarget, 0.0, 6.0);
  for (std::size_t n = 0; n < in.time_s.size(); ++n) in.command[n] = 0.5 * in.time_s[n];
  const auto stops = [&](const EffectSet<double>& effects) {
    const auto out = run_axis(p, effects, in);
    int count = 0;
    for (std::size_t n = 2001; n < out.size(); ++n) count += out[n].held && !out[n - 1].held ? 1 : 0;
    return count;
  };
  EXPECT_EQ(stops(nothing()), 0);
  EXPECT_GE(stops(with({use_of("stribeck_friction", {0.003, 2.0})})), 5);
}

}  // namespace
}  // namespace omnihil::test
