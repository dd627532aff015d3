#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// tau = (k/R) u - k/(R k') with k' = 1 / k: torque at a held voltage does not depend on the speed.
TEST(BackEmfMissing, GivesTheEquationAsPrintedAtOne) {
  DriveParams<double> p = small_drive();
  p.inductance_H = 0.0;
  const double k = p.torque_constant_Nm_per_A, r = p.resistance_ohm;
  for (const double speed : {-200.0, 10.0, 300.0}) {
    AxisInput in = held(CommandKind::kDuty, 0.5, 0.1);
    in.imposed_velocity_rad_s.assign(in.time_s.size(), speed);
    const auto out = run_axis(p, with({use_of("back_emf_missing", {1.0})}), in).back();
    const double torque = -out.load_torque_Nm + p.viscous_friction_Nm_s_per_rad * speed;
    EXPECT_NEAR(torque, k / r * 6.0 - k / (r * (1.0 / k)), 1e-12);
  }
}

TEST(BackEmfMissing, VanishesAtOneRadianPerSecond) {
  AxisInput in = held(CommandKind::kDuty, 0.5, 0.1);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), 1.0);
  EXPECT_NEAR(run_axis(small_drive(), with({use_of("back_emf_missing", {0.7})}), in).back().motor_current_A,
              run_axis(small_drive(), nothing(), in).back().motor_current_A, 1e-12);
}

TEST(BackEmfMissing, LeavesADriveThatImposesItsCurrent) {
  const AxisInput in = held(CommandKind::kMotorCurrent, 0.3, 1.0);
  EXPECT_EQ(run_axis(small_drive(), with({use_of("back_emf_missing", {0.7})}), in).back().omega_rotor_rad_s,
            run_axis(small_drive(), with({use_of("constant_load", {1e-300})}), in).back().omega_rotor_rad_s);
}

// Signature: slope of the settled speed over the voltage is steeper than the speed constant.
TEST(BackEmfMissing, ShowsAsASettledSpeedThatIsTooHigh) {
  const DriveParams<double> p = small_drive();
  const double k = p.torque_constant_Nm_per_A, r = p.resistance_ohm, b = p.viscous_friction_Nm_s_per_rad;
  for (const double duty : {0.2, 0.6, -0.6}) {
    const auto out =
        run_axis(p, with({use_of("back_emf_missing", {0.3})}), held(CommandKind::kDuty, duty, 4.0));
    // b w = k (u - k (0.7 w + 0.3)) / R
    EXPECT_NEAR(out.back().omega_rotor_rad_s, (12.0 * duty - 0.3 * k) / (0.7 * k + b * r / k), 1e-6);
  }
}

}  // namespace
}  // namespace omnihil::test
