#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveParams<double> geared() {
  DriveParams<double> p = small_drive();
  p.gear_ratio = 3.0;
  p.coulomb_friction_Nm = 0.002;
  return p;
}

// Free rotor: J domega/dt = M / N
TEST(ConstantLoad, AcceleratesAFreeRotor) {
  DriveParams<double> p = geared();
  p.coulomb_friction_Nm = p.viscous_friction_Nm_s_per_rad = 0.0;
  const auto out =
      run_axis(p, with({use_of("constant_load", {0.03})}), held(CommandKind::kMotorTorque, 0.0, 0.5)).back();
  EXPECT_NEAR(out.omega_rotor_rad_s, 0.03 / 3.0 / inertia_at_rotor(p) * 0.5, 1e-6);
}

TEST(ConstantLoad, MovesNothingBelowTheFrictionLevel) {
  const AxisInput in = held(CommandKind::kMotorTorque, 0.0, 0.1);
  EXPECT_TRUE(run_axis(geared(), with({use_of("constant_load", {0.00599})}), in).back().held);
  EXPECT_FALSE(run_axis(geared(), with({use_of("constant_load", {0.00601})}), in).back().held);
}

TEST(ConstantLoad, IsTheSameAsAKnownLoadOfTheBench) {
  AxisInput in = excite(Excitation::kSteps, 0.6, 2.0);
  const auto effect = run_axis(geared(), with({use_of("constant_load", {-0.02})}), in);
  in.load_torque_Nm.assign(in.time_s.size(), -0.02);
  const auto bench = run_axis(geared(), nothing(), in);
  for (std::size_t n = 0; n < bench.size(); ++n) {
    EXPECT_NEAR(effect[n].omega_rotor_rad_s, bench[n].omega_rotor_rad_s, 1e-6);
  }
}

// Signature: the sum of the steady currents of both directions, the same at every speed.
TEST(ConstantLoad, ShowsAsACurrentThatKeepsItsSign) {
  const DriveParams<double> p = geared();
  const auto effects = with({use_of("constant_load", {0.005})});
  for (const double speed : {5.0, 30.0, 100.0}) {
    double sum = 0.0;
    for (const double sign : {1.0, -1.0}) {
      AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.1);
      in.imposed_velocity_rad_s.assign(in.time_s.size(), sign * speed);
      sum += run_axis(p, effects, in).back().load_torque_Nm;
    }
    EXPECT_NEAR(0.5 * sum, -0.005, 1e-12);
  }
}

}  // namespace
}  // namespace omnihil::test
