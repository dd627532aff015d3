#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// k i = b omega + c, so at a held duty omega = (k u / R - c) / (k^2 / R + b).
TEST(CoulombFriction, LowersTheSettledSpeedByItsTorque) {
  const DriveParams<double> p = small_drive();
  const double c = 0.003, k = p.torque_constant_Nm_per_A, r = p.resistance_ohm;
  const auto out = run_axis(p, with({use_of("coulomb_friction", {c})}), held(CommandKind::kDuty, 0.5, 3.0));
  EXPECT_NEAR(out.back().omega_rotor_rad_s, (k * 6.0 / r - c) / (k * k / r + p.viscous_friction_Nm_s_per_rad),
              1e-9);
}

TEST(CoulombFriction, VanishesInTheLimitOfNoTorque) {
  const AxisInput in = excite(Excitation::kSteps, 0.8, 2.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  const auto tiny = run_axis(small_drive(), with({use_of("coulomb_friction", {1e-9})}), in);
  for (std::size_t n = 0; n < without.size(); ++n) {
    EXPECT_NEAR(tiny[n].omega_rotor_rad_s, without[n].omega_rotor_rad_s, 1e-3);
  }
}

// Two levels at the same place hold together, not one after the other.
TEST(CoulombFriction, AddsUpWithTheFrictionOfTheMotor) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.002;
  const double k = p.torque_constant_Nm_per_A;
  const auto effects = with({use_of("coulomb_friction", {0.003})});
  EXPECT_TRUE(run_axis(p, effects, held(CommandKind::kMotorCurrent, 0.0049 / k, 0.1)).back().held);
  EXPECT_FALSE(run_axis(p, effects, held(CommandKind::kMotorCurrent, 0.0051 / k, 0.1)).back().held);
}

// Signature: in a slow creep through zero the rotor stands still over a band of duty of width 2 c R / (k u).
TEST(CoulombFriction, ShowsAsADeadBandAtSlowReversal) {
  const DriveParams<double> p = small_drive();
  const double c = 0.003;
  const AxisInput in = excite(Excitation::kCreep, 1.0, 16.0);
  const auto out = run_axis(p, with({use_of("coulomb_friction", {c})}), in);
  double most_held = 0.0;
  for (std::size_t n = 4000; n < 12000;
       ++n) {  // the falling flank: starts backwards where -duty exceeds the level
    if (out[n].held) most_held = std::max(most_held, -in.command[n]);
  }
  EXPECT_NEAR(most_held, c * p.resistance_ohm / (p.torque_constant_Nm_per_A * p.supply_voltage_V), 2e-4);
}

}  // namespace
}  // namespace omnihil::test
