#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

TEST(CurrentLimit, HoldsALockedRotorAtItsCurrent) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  const auto effects = with({use_of("current_limit", {0.2})});
  for (const double sign : {1.0, -1.0}) {  // 8 A without
    const auto out = run_axis(p, effects, held(CommandKind::kDuty, 0.8 * sign, 0.2)).back();
    EXPECT_NEAR(out.motor_current_A, 5.0 * sign, 1e-9);
  }
}

TEST(CurrentLimit, ChangesNothingBelow) {
  const AxisInput in = excite(Excitation::kSteps, 0.8, 2.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  const auto far = run_axis(small_drive(), with({use_of("current_limit", {0.01})}), in);
  for (std::size_t n = 0; n < far.size(); ++n) {
    EXPECT_NEAR(far[n].omega_rotor_rad_s, without[n].omega_rotor_rad_s, 1e-9);
  }
}

TEST(CurrentLimit, LeavesALowerLimitOfTheModelInPlace) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  p.current_limit_A = 2.0;
  const auto out =
      run_axis(p, with({use_of("current_limit", {0.2})}), held(CommandKind::kDuty, 0.8, 0.2)).back();
  EXPECT_NEAR(out.motor_current_A, 2.0, 1e-9);
}

// Signature: after a hard step the current is flat and J domega/dt = k i_max - b omega.
TEST(CurrentLimit, ShowsAsAFlatTopOfTheCurrent) {
  const DriveParams<double> p = small_drive();
  const auto out = run_axis(p, with({use_of("current_limit", {0.2})}), held(CommandKind::kDuty, 1.0, 0.05));
  for (std::size_t n = 5; n < 45; ++n) EXPECT_NEAR(out[n].motor_current_A, 5.0, 1e-6);
  const double b = p.viscous_friction_Nm_s_per_rad, settled = p.torque_constant_Nm_per_A * 5.0 / b;
  const double rate = b / inertia_at_rotor(p);
  EXPECT_NEAR(out[40].omega_rotor_rad_s,
              settled + (out[10].omega_rotor_rad_s - settled) * std::exp(-rate * 0.03), 1e-6);
}

}  // namespace
}  // namespace omnihil::test
