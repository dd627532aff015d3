#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// In the play nothing passes: after a kick within it only the rotor turns, by tau t / J_r.
TEST(Backlash, LeavesTheOutputAloneWithinThePlay) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 0.004, 10000.0);
  in.command[0] = 0.001;
  in.encoder_on_output = true;
  const auto out = run_axis(p, with({use_of("backlash", {0.1})}), in).back();
  EXPECT_NEAR(out.omega_rotor_rad_s, 0.001 * 1e-4 / p.rotor_inertia_kg_m2, 1e-12);
  EXPECT_EQ(out.velocity_rad_s, 0.0);
}

// The encoder may count the rotor; a sensor of angle or speed tells what the output does.
TEST(Backlash, IsSeenByASensorOfSpeedAtTheOutput) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 0.004, 10000.0);
  in.command[0] = 0.001;
  in.encoder_counts_per_turn = 4096.0;
  const auto out = run_axis(p, with({use_of("backlash", {0.1})}), in).back();
  const double turned_rad = out.encoder_counts * 2.0 * std::numbers::pi / 4096.0;
  EXPECT_NEAR(turned_rad, out.theta_rotor_rad, 1e-12);
  EXPECT_GT(turned_rad, 1e-5);
  EXPECT_EQ(out.velocity_rad_s, 0.0);
  EXPECT_EQ(out.position_rad, 0.0);
}

// In contact it is a spring with a damper: twist beyond the play = torque times compliance.
TEST(Backlash, GivesInContactAsItsFlanksDo) {
  DriveParams<double> p = small_drive();
  AxisInput in = held(CommandKind::kMotorTorque, 0.01, 2.0);
  in.load_torque_Nm.assign(in.time_s.size(), -0.01);
  in.encoder_counts_per_turn = 2.0 * std::numbers::pi;
  const auto out = run_axis(p, with({use_of("backlash", {0.02, 0.5, 0.01})}), in).back();
  EXPECT_NEAR(out.encoder_counts - out.position_rad, 0.01 + 0.5 * 0.01, 1e-4);
}

TEST(Backlash, IsRigidInTheLimitOfNoGap) {
  const AxisInput in = excite(Excitation::kSteps, 0.8, 1.0);
  const auto rigid = run_axis(small_drive(), nothing(), in);
  const auto tight = run_axis(small_drive(), with({use_of("backlash", {1e-9, 0.0, 0.0})}), in);
  for (std::size_t n = 0; n < tight.size(); ++n) {
    EXPECT_NEAR(tight[n].omega_rotor_rad_s, rigid[n].omega_rotor_rad_s, 0.5);
  }
}

// Impacts or not, nothing outside: J_r omega_r + J_o omega_o = sum of the rotor's impulses; and the twist
// stays within the play.
TEST(Backlash, KeepsTheMomentumOfBothMassesAndTheTwistWithinThePlay) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = excite(Excitation::kPrbs, 0.01, 2.0);
  in.kind = CommandKind::kMotorTorque;
  in.encoder_on_output = true;
  const auto out = run_axis(p, with({use_of("backlash", {0.01, 0.0, 0.0})}), in);
  double impulse = 0.0, most = 0.0;
  for (std::size_t n = 1; n < out.size(); ++n) {
    impulse += in.command[n - 1] * 1e-3;
    EXPECT_NEAR(
        p.rotor_inertia_kg_m2 * out[n].omega_rotor_rad_s + p.load_inertia_kg_m2 * out[n].velocity_rad_s,
        impulse, 1e-12);
    most = std::max(most, std::abs(out[n].theta_rotor_rad - out[n].position_rad));
  }
  EXPECT_GT(most, 0.0049);
  EXPECT_LT(most, 0.0051);
}

// Impacts take energy, never give it.
TEST(Backlash, NeverAddsEnergy) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 2.0);
  in.command[0] = 0.05;
  in.encoder_on_output = true;
  const auto out = run_axis(p, with({use_of("backlash", {0.01, 0.0, 0.0})}), in);
  const auto energy = [&](const AxisSample<double>& s) {
    return 0.5 * p.rotor_inertia_kg_m2 * s.omega_rotor_rad_s * s.omega_rotor_rad_s +
           0.5 * p.load_inertia_kg_m2 * s.velocity_rad_s * s.velocity_rad_s;
  };
  const double given = energy(out[1]);
  for (const auto& s : out) EXPECT_LE(energy(s), given * (1.0 + 1e-9));
}

// Signature: the bench turns the output slowly to and fro; the rotor, held by its friction, follows with a
// hysteresis as wide as the gap.
TEST(Backlash, ShowsAsHysteresisOfRotorAgainstOutputAtReversal) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.003;
  const double gap = 0.01;
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 4.0);
  in.encoder_on_output = true;
  in.imposed_velocity_rad_s.resize(in.time_s.size());
  for (std::size_t n = 0; n < in.time_s.size(); ++n) {
    in.imposed_velocity_rad_s[n] = 0.5 * std::cos(2.0 * M_PI * in.time_s[n]);
  }
  const auto out = run_axis(p, with({use_of("backlash", {gap})}), in);
  const auto lead = [&](std::size_t n) { return out[n].theta_rotor_rad - out[n].position_rad; };
  for (const std::size_t period : {1000u, 2000u}) {
    const double forward = lead(period + 200), back = lead(period + 700);  // well after each reversal
    EXPECT_NEAR(back - forward, gap, 0.02 * gap);
  }
}

}  // namespace
}  // namespace omnihil::test
