#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double torque_at(const EffectSet<double>& effects, double speed_rad_s) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.05);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
  return run_axis(small_drive(), effects, in).back().load_torque_Nm;
}

TEST(QuadraticDrag, GrowsWithTheSquareOfTheSpeed) {
  const auto effects = with({use_of("quadratic_drag", {2e-8})});
  EXPECT_NEAR(torque_at(effects, 300.0), 5e-6 * 300.0 + 2e-8 * 9e4, 1e-12);
  EXPECT_NEAR(torque_at(effects, -300.0), -torque_at(effects, 300.0), 1e-15);
}

TEST(QuadraticDrag, VanishesAtLowSpeed) {
  const auto effects = with({use_of("quadratic_drag", {2e-8})});
  EXPECT_NEAR(torque_at(effects, 0.1), 5e-6 * 0.1, 1e-9);
}

// Alone it never stops a rotor: 1 / omega grows in proportion to time, J d(1/omega)/dt = q.
TEST(QuadraticDrag, SlowsACoastingRotorHyperbolically) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 2.0);
  in.initial_velocity_rad_s = 400.0;
  const double q = 1e-6;
  const auto out = run_axis(p, with({use_of("quadratic_drag", {q})}), in);
  for (const std::size_t n : {100u, 1000u, 2000u}) {
    const double expected = 1.0 / (1.0 / 400.0 + q * out[n].time_s / inertia_at_rotor(p));
    EXPECT_NEAR(out[n].omega_rotor_rad_s, expected, 1e-5 * expected);
  }
}

TEST(QuadraticDrag, StaysStableHoweverLargeItIs) {
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 0.1);
  in.initial_velocity_rad_s = 400.0;
  const auto out = run_axis(small_drive(), with({use_of("quadratic_drag", {1.0})}), in);
  for (std::size_t n = 1; n < out.size(); ++n) {
    EXPECT_LE(std::abs(out[n].omega_rotor_rad_s), 400.0);
  }
}

// Signature: curvature of the no-load current over the speed.
TEST(QuadraticDrag, ShowsAsCurvatureOfTheNoLoadCurrent) {
  const DriveParams<double> p = small_drive();
  const auto effects = with({use_of("quadratic_drag", {2e-8})});
  double w[3], i[3];
  for (int n = 0; n < 3; ++n) {
    const auto out = run_axis(p, effects, held(CommandKind::kDuty, 0.3 * (n + 1), 4.0)).back();
    w[n] = out.omega_rotor_rad_s, i[n] = out.motor_current_A;
  }
  // second divided difference of a parabola is its leading coefficient
  const double second = ((i[2] - i[1]) / (w[2] - w[1]) - (i[1] - i[0]) / (w[1] - w[0])) / (w[2] - w[0]);
  EXPECT_NEAR(second * p.torque_constant_Nm_per_A, 2e-8, 2e-11);
}

}  // namespace
}  // namespace omnihil::test
