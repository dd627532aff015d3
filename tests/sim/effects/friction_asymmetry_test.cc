#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveParams<double> with_friction() {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.003;
  p.viscous_friction_Nm_s_per_rad = 2e-5;
  return p;
}

// Bench torque at a held speed.
double torque_at(const EffectSet<double>& effects, double speed_rad_s) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.1);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
  return run_axis(with_friction(), effects, in).back().load_torque_Nm;
}

TEST(FrictionAsymmetry, PartsCoulombAndViscousByTheirRatios) {
  const auto effects = with({use_of("friction_asymmetry", {0.2, -0.1})});
  EXPECT_NEAR(torque_at(effects, 100.0), 0.003 * 1.2 + 2e-5 * 0.9 * 100.0, 1e-12);
  EXPECT_NEAR(torque_at(effects, -100.0), -(0.003 * 0.8 + 2e-5 * 1.1 * 100.0), 1e-12);
}

TEST(FrictionAsymmetry, LeavesNoFrictionOneWayInTheLimit) {
  const auto effects = with({use_of("friction_asymmetry", {1.0, -1.0})});
  EXPECT_NEAR(torque_at(effects, 100.0), 2.0 * 0.003, 1e-12);
  EXPECT_NEAR(torque_at(effects, -100.0), -2.0 * 2e-5 * 100.0, 1e-12);
}

TEST(FrictionAsymmetry, KeepsTheSumOfBothDirections) {
  for (const double ratio : {-0.5, 0.1, 0.9}) {
    const auto effects = with({use_of("friction_asymmetry", {ratio, -ratio})});
    EXPECT_NEAR(torque_at(effects, 80.0) - torque_at(effects, -80.0), 2.0 * (0.003 + 2e-5 * 80.0), 1e-12);
  }
}

TEST(FrictionAsymmetry, PartsTheEffectCoulombFrictionToo) {
  const auto effects = with({use_of("friction_asymmetry", {0.5}), use_of("coulomb_friction", {0.001})});
  EXPECT_NEAR(torque_at(effects, 10.0), 1.5 * 0.004 + 2e-5 * 10.0, 1e-12);
}

// Signature: currents of the two directions differ, by a dry part and a part that grows with speed.
TEST(FrictionAsymmetry, ShowsAsADifferenceOfTheCurrentsOfBothDirections) {
  const DriveParams<double> p = with_friction();
  const auto effects = with({use_of("friction_asymmetry", {0.2, 0.18})});
  for (const double duty : {0.2, 0.8}) {
    const auto forward = run_axis(p, effects, held(CommandKind::kDuty, duty, 3.0)).back();
    const auto back = run_axis(p, effects, held(CommandKind::kDuty, -duty, 3.0)).back();
    const double k = p.torque_constant_Nm_per_A;
    EXPECT_NEAR(k * forward.motor_current_A, 0.0036 + 2e-5 * 1.18 * forward.omega_rotor_rad_s, 1e-9);
    EXPECT_NEAR(k * back.motor_current_A, -0.0024 + 2e-5 * 0.82 * back.omega_rotor_rad_s, 1e-9);
    EXPECT_LT(forward.omega_rotor_rad_s, -back.omega_rotor_rad_s);
  }
}

}  // namespace
}  // namespace omnihil::test
