#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// Speed after a torque is held on a rotor from a starting speed.
double acceleration(const EffectSet<double>& effects, double torque_Nm, double from_rad_s) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, torque_Nm, 0.01);
  in.initial_velocity_rad_s = from_rad_s;
  return (run_axis(p, effects, in).back().omega_rotor_rad_s - from_rad_s) / 0.01;
}

// Driving eta tau arrives, braking tau / eta: the power that is lost warms the gear both times.
TEST(GearEfficiency, TakesLessWhenDrivingAndMoreWhenBraking) {
  const double j = inertia_at_rotor(small_drive()), eta = 0.9;
  const auto effects = with({use_of("gear_efficiency", {1.0 - eta})});
  EXPECT_NEAR(acceleration(effects, 0.02, 100.0), eta * 0.02 / j, 1e-6);
  EXPECT_NEAR(acceleration(effects, -0.02, 100.0), -0.02 / eta / j, 1e-6);
}

TEST(GearEfficiency, VanishesInTheLimitOfNoLoss) {
  const double j = inertia_at_rotor(small_drive());
  const auto effects = with({use_of("gear_efficiency", {1e-12})});
  EXPECT_NEAR(acceleration(effects, 0.02, 100.0), 0.02 / j, 1e-6);
  EXPECT_NEAR(acceleration(effects, -0.02, 100.0), -0.02 / j, 1e-6);
}

TEST(GearEfficiency, DependsOnThePowersDirectionNotOnTheRotors) {
  const auto effects = with({use_of("gear_efficiency", {0.1})});
  for (const double torque : {0.02, -0.02}) {
    EXPECT_EQ(acceleration(effects, torque, 100.0), -acceleration(effects, -torque, -100.0));
  }
}

// The gear loses what it is said to lose: output power over input power is eta at a steady load.
TEST(GearEfficiency, HasTheOutputPowerItClaims) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kDuty, 0.6, 3.0);
  in.load_torque_Nm.assign(in.time_s.size(), -0.02);
  const auto out = run_axis(p, with({use_of("gear_efficiency", {0.06})}), in).back();
  EXPECT_NEAR(0.02 / (p.torque_constant_Nm_per_A * out.motor_current_A), 0.94, 1e-9);
}

// Signature: the same current accelerates less than it brakes, by eta squared.
TEST(GearEfficiency, ShowsInPairsOfAcceleratingAndBraking) {
  const DriveParams<double> p = small_drive();
  const auto effects = with({use_of("gear_efficiency", {0.06})});
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.08);
  for (std::size_t n = 0; n < in.time_s.size(); ++n) in.command[n] = n < 40 ? 1.0 : -1.0;
  const auto out = run_axis(p, effects, in);
  const auto slope = [&](std::size_t from, std::size_t to) {
    return (out[to].omega_rotor_rad_s - out[from].omega_rotor_rad_s) / (out[to].time_s - out[from].time_s);
  };
  const double up = slope(20, 40), down = -slope(40, 60);
  // viscous friction helps braking: 5e-6 of about 30 rad/s against 25 mN m
  EXPECT_NEAR(up / down, 0.94 * 0.94, 0.015);
}

}  // namespace
}  // namespace omnihil::test
