#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveParams<double> geared() {
  DriveParams<double> p = small_drive();
  p.gear_ratio = 3.0;
  return p;
}

// The base model's gravity and this effect are the same law.
TEST(GravityLoad, IsTheBaseModelsGravityTorque) {
  DriveParams<double> base = geared();
  base.gravity_torque_Nm = 0.05;
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 2.0);
  in.initial_position_rad = 2.0;
  const auto expected = run_axis(base, nothing(), in);
  const auto out = run_axis(geared(), with({use_of("gravity_load", {0.05, 0.0})}), in);
  for (std::size_t n = 0; n < out.size(); ++n) {
    EXPECT_NEAR(out[n].position_rad, expected[n].position_rad, 1e-9);
  }
}

// Small swings about hanging: period 2 pi sqrt(J_out / (m g l)).
TEST(GravityLoad, SwingsLikeAPendulumInTheLimitOfSmallAngles) {
  DriveParams<double> p = geared();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  const double j_out = 9.0 * inertia_at_rotor(p);
  const double period_s = 2.0 * std::numbers::pi * std::sqrt(j_out / 0.05);
  AxisInput in;
  in.kind = CommandKind::kMotorTorque;
  for (int n = 0; n <= 1000; ++n) in.time_s.push_back(n * period_s / 1000.0);
  in.command.assign(in.time_s.size(), 0.0);
  in.initial_position_rad = 0.001 - 0.7;
  const auto out = run_axis(p, with({use_of("gravity_load", {0.05, 0.7})}), in);
  EXPECT_NEAR(out.back().position_rad + 0.7, 0.001, 1e-7);
  EXPECT_NEAR(out[500].position_rad + 0.7, -0.001, 1e-7);
}

TEST(GravityLoad, KeepsTheEnergyOfASwing) {
  DriveParams<double> p = geared();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 3.0);
  in.initial_position_rad = 2.5;
  const double j_out = 9.0 * inertia_at_rotor(p);
  for (const auto& s : run_axis(p, with({use_of("gravity_load", {0.05, 0.0})}), in)) {
    const double energy = 0.5 * j_out * s.velocity_rad_s * s.velocity_rad_s - 0.05 * std::cos(s.position_rad);
    EXPECT_NEAR(energy, -0.05 * std::cos(2.5), 1e-5);
  }
}

// Signature: the torque that slow turning takes has one line, once per turn of the output; same both ways.
TEST(GravityLoad, ShowsAsALineOncePerTurnOfTheOutput) {
  for (const double sign : {1.0, -1.0}) {
    AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 4.0);
    in.imposed_velocity_rad_s.assign(in.time_s.size(), sign * 2.0 * std::numbers::pi / 4.0);
    const auto out = run_axis(geared(), with({use_of("gravity_load", {0.02, 0.4})}), in);
    for (const int order : {1, 2, 3}) {
      double re = 0, im = 0;
      for (std::size_t n = 1; n < out.size(); ++n) {
        re += out[n].load_torque_Nm * std::sin(order * out[n].position_rad + 0.4);
        im += out[n].load_torque_Nm * std::cos(order * out[n].position_rad + 0.4);
      }
      const double count = static_cast<double>(out.size() - 1);
      EXPECT_NEAR(2.0 * re / count, order == 1 ? 0.02 : 0.0, 2e-5) << order;
      EXPECT_NEAR(2.0 * im / count, 0.0, 2e-5) << order;
    }
  }
}

}  // namespace
}  // namespace omnihil::test
