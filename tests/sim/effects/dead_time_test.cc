#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// Locked rotor, settled: R i = u - V i / sqrt(i^2 + w^2).
TEST(DeadTime, TakesItsVoltageFromALockedRotor) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  const auto out = run_axis(p, with({use_of("dead_time", {0.4, 0.1})}), held(CommandKind::kDuty, 0.2, 0.5));
  const double i = out.back().motor_current_A;
  EXPECT_NEAR(p.resistance_ohm * i, 0.2 * 12.0 - 0.4 * i / std::hypot(i, 0.1), 1e-9);
  EXPECT_NEAR(i, 2.0 / 1.2, 2e-3);  // nearly all of it, far above the width
}

TEST(DeadTime, VanishesAtCurrentsFarBelowItsWidth) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  const auto out = run_axis(p, with({use_of("dead_time", {0.4, 10.0})}), held(CommandKind::kDuty, 1e-3, 0.5));
  // V i / w: a resistance of 0.04 ohm
  EXPECT_NEAR(out.back().motor_current_A, 0.012 / (1.2 + 0.04), 1e-7);
}

// The law turns over within a width that no sub-step resolves; R i = u - V i / sqrt(i^2 + w^2) all the same, at any
// inductance, also where |u| < V and nearly nothing flows.
TEST(DeadTime, SettlesBelowItsVoltageWhateverTheWidth) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  for (const double inductance_H : {0.0, 1e-5, p.inductance_H}) {
    p.inductance_H = inductance_H;
    for (const double width_A : {0.001, 0.02, 0.3}) {
      for (const double duty : {0.01, 0.05, -0.02}) {
        const auto out =
            run_axis(p, with({use_of("dead_time", {0.4, width_A})}), held(CommandKind::kDuty, duty, 0.05));
        const double i = out.back().motor_current_A;
        EXPECT_NEAR(p.resistance_ohm * i, duty * 12.0 - 0.4 * i / std::hypot(i, width_A), 1e-6)
            << inductance_H << " H, " << width_A << " A, duty " << duty;
        // of the current of a sub-step as well as of its mean
        EXPECT_NEAR(out[out.size() / 2].motor_current_A, i, 1e-6);
      }
    }
  }
}

TEST(DeadTime, IsTheSameBothWays) {
  const auto effects = with({use_of("dead_time", {0.4, 0.2})});
  const auto forward = run_axis(small_drive(), effects, excite(Excitation::kSteps, 0.7, 2.0));
  const auto back = run_axis(small_drive(), effects, excite(Excitation::kSteps, -0.7, 2.0));
  for (std::size_t n = 0; n < forward.size(); ++n)
    EXPECT_EQ(forward[n].omega_rotor_rad_s, -back[n].omega_rotor_rad_s);
}

// Signature: voltage asked less R i and k omega steps with the current's sign, the current itself does not.
TEST(DeadTime, ShowsAsAVoltageAgainstTheCurrentsSign) {
  const DriveParams<double> p = small_drive();
  for (const double sign : {1.0, -1.0}) {
    AxisInput in = held(CommandKind::kDuty, 0.3 * sign, 2.0);
    in.load_torque_Nm.assign(in.time_s.size(), -0.02 * sign);  // enough current to be past the width
    const auto out = run_axis(p, with({use_of("dead_time", {0.4, 0.1})}), in).back();
    const double missing = 0.3 * sign * 12.0 - p.resistance_ohm * out.motor_current_A -
                           p.torque_constant_Nm_per_A * out.omega_rotor_rad_s;
    EXPECT_NEAR(missing, 0.4 * sign, 0.4 * 0.01);  // 1 - w^2 / (2 i^2)
    EXPECT_NEAR(out.motor_current_A * p.torque_constant_Nm_per_A,
                0.02 * sign + p.viscous_friction_Nm_s_per_rad * out.omega_rotor_rad_s, 1e-9);
  }
}

}  // namespace
}  // namespace omnihil::test
