#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double torque_at(const DriveParams<double>& p, const EffectSet<double>& effects, double speed_rad_s) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.05);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
  return run_axis(p, effects, in).back().load_torque_Nm;
}

DriveParams<double> without_friction() {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  return p;
}

TEST(GreaseDrag, HasRisenTo63PercentAtItsSpeed) {
  const auto effects = with({use_of("grease_drag", {0.002, 10.0})});
  EXPECT_NEAR(torque_at(without_friction(), effects, 10.0), 0.002 * (1.0 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(torque_at(without_friction(), effects, -20.0), -0.002 * (1.0 - std::exp(-2.0)), 1e-12);
}

TEST(GreaseDrag, IsDryFrictionFarAboveItsSpeedAndViscousFrictionFarBelow) {
  const auto effects = with({use_of("grease_drag", {0.002, 10.0})});
  EXPECT_NEAR(torque_at(without_friction(), effects, 300.0), 0.002, 1e-12);
  EXPECT_NEAR(torque_at(without_friction(), effects, 1e-6), 0.002 / 10.0 * 1e-6, 1e-15);
  EXPECT_NEAR(torque_at(without_friction(), effects, 1e-2), 0.002 / 10.0 * 1e-2, 1e-8);
}

TEST(GreaseDrag, HoldsNothingAtRest) {
  const auto effects = with({use_of("grease_drag", {0.002, 10.0})});
  const AxisInput in = held(CommandKind::kMotorCurrent, 1e-4, 0.1);
  EXPECT_FALSE(run_axis(without_friction(), effects, in).back().held);
}

TEST(GreaseDrag, StaysStableHoweverLargeItIs) {
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 0.1);
  in.initial_velocity_rad_s = 400.0;
  const auto out = run_axis(small_drive(), with({use_of("grease_drag", {10.0, 0.05})}), in);
  for (std::size_t n = 1; n < out.size(); ++n)
    EXPECT_LE(std::abs(out[n].omega_rotor_rad_s), std::abs(out[n - 1].omega_rotor_rad_s));
}

// Signature: the torque rises over the speed, ever less, and ends parallel to the line of viscous friction.
TEST(GreaseDrag, ShowsAsATorqueThatBendsOverTheSpeed) {
  const DriveParams<double> p = small_drive();
  const auto effects = with({use_of("grease_drag", {0.002, 10.0})});
  double before = INFINITY;
  for (const double speed : {1.0, 5.0, 15.0, 40.0}) {
    const double slope = (torque_at(p, effects, speed + 0.1) - torque_at(p, effects, speed)) / 0.1;
    EXPECT_LT(slope, before);
    before = slope;
  }
  const double far = (torque_at(p, effects, 300.0) - torque_at(p, effects, 200.0)) / 100.0;
  EXPECT_NEAR(far, p.viscous_friction_Nm_s_per_rad, 1e-9);
}

}  // namespace
}  // namespace omnihil::test
