#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveParams<double> free_masses() {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  return p;
}

// A kick of the rotor's torque over the first ten milliseconds, then nothing.
AxisInput kick(double torque_Nm) {
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 0.3, 10000.0);
  for (std::size_t n = 0; n < 10; ++n) in.command[n] = torque_Nm;
  in.encoder_on_output = true;
  return in;
}

// Rotor held by friction, a known torque on the output: twist = c tau.
TEST(ShaftCompliance, TwistsByTorqueTimesCompliance) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  AxisInput in = held(CommandKind::kMotorTorque, 0.0, 2.0);
  in.encoder_on_output = true;
  in.load_torque_Nm.assign(in.time_s.size(), 0.05);
  const auto out = run_axis(p, with({use_of("shaft_compliance", {0.2, 0.01})}), in).back();
  EXPECT_NEAR(out.position_rad, 0.2 * 0.05, 1e-3 * 0.2 * 0.05);
  EXPECT_EQ(out.theta_rotor_rad, 0.0);
}

TEST(ShaftCompliance, IsRigidInTheLimit) {
  const AxisInput in = excite(Excitation::kSteps, 0.8, 1.0);
  const auto rigid = run_axis(small_drive(), nothing(), in);
  const auto stiff = run_axis(small_drive(), with({use_of("shaft_compliance", {1e-6, 0.01})}), in);
  for (std::size_t n = 0; n < stiff.size(); ++n) {
    EXPECT_NEAR(stiff[n].omega_rotor_rad_s, rigid[n].omega_rotor_rad_s, 0.5);
  }
}

// Nothing outside: momentum stays what the kick gave, J_r omega_r + J_o omega_o = tau t.
TEST(ShaftCompliance, KeepsTheMomentumOfBothMasses) {
  const DriveParams<double> p = free_masses();
  const auto out = run_axis(p, with({use_of("shaft_compliance", {0.2, 0.0})}), kick(0.05));
  for (std::size_t n = 20; n < out.size(); ++n) {
    EXPECT_NEAR(
        p.rotor_inertia_kg_m2 * out[n].omega_rotor_rad_s + p.load_inertia_kg_m2 * out[n].velocity_rad_s,
        0.05 * 1e-3, 1e-12);
  }
}

TEST(ShaftCompliance, KeepsItsEnergyWithoutDamping) {
  const DriveParams<double> p = free_masses();
  const auto out = run_axis(p, with({use_of("shaft_compliance", {0.2, 0.0})}), kick(0.05));
  const auto energy = [&](const AxisSample<double>& s) {
    const double twist = s.theta_rotor_rad - s.position_rad;
    return 0.5 * p.rotor_inertia_kg_m2 * s.omega_rotor_rad_s * s.omega_rotor_rad_s +
           0.5 * p.load_inertia_kg_m2 * s.velocity_rad_s * s.velocity_rad_s + 0.5 * twist * twist / 0.2;
  };
  for (std::size_t n = 20; n < out.size(); ++n) EXPECT_NEAR(energy(out[n]) / energy(out[20]), 1.0, 3e-3);
}

// Signature: the speeds ring at sqrt((1/J_r + 1/J_o) / c), whatever the size of the kick.
TEST(ShaftCompliance, ShowsAsAResonanceAtTheSameFrequencyForEveryAmplitude) {
  const DriveParams<double> p = free_masses();
  const double expected_Hz =
      std::sqrt((1.0 / p.rotor_inertia_kg_m2 + 1.0 / p.load_inertia_kg_m2) / 0.2) / (2.0 * M_PI);
  for (const double torque : {0.01, 0.1}) {
    const auto out = run_axis(p, with({use_of("shaft_compliance", {0.2, 0.0})}), kick(torque));
    double first = 0.0, last = 0.0;
    int crossings = 0;
    for (std::size_t n = 21; n < out.size(); ++n) {
      const double a = out[n - 1].omega_rotor_rad_s - out[n - 1].velocity_rad_s;
      const double b = out[n].omega_rotor_rad_s - out[n].velocity_rad_s;
      if (a <= 0.0 && b > 0.0) {
        last = out[n - 1].time_s + 1e-4 * a / (a - b);
        if (crossings++ == 0) first = last;
      }
    }
    ASSERT_GT(crossings, 20);
    EXPECT_NEAR((crossings - 1) / (last - first), expected_Hz, 2e-3 * expected_Hz) << torque;
  }
}

// Inverse dynamics by the rotor's own sensor: the rotor's motion is given, the output follows by the spring. What the motor
// must give is J_r a + the spring's torque, with w_o = w_r / (1 - (w / w_a)^2) at frequency w, w_a^2 = 1 / (c J_o): around w_a
// the rotor hardly moves and the torque is large. (J_r + J_o) a, as the output's sensor would have it, is far from that.
TEST(ShaftCompliance, OfAnImposedRotorTheOutputSwings) {
  const DriveParams<double> p = free_masses();
  const auto effects = with({use_of("shaft_compliance", {0.2, 2e-3})});
  AxisInput forward = held(CommandKind::kMotorTorque, 0.0, 1.0, 10000.0);
  for (std::size_t n = 0; n < forward.command.size(); ++n)
    forward.command[n] = 0.02 * std::sin(2.0 * std::numbers::pi * 60.0 * forward.time_s[n]);
  const auto moved = run_axis(p, effects, forward);
  AxisInput inverse = held(CommandKind::kMotorTorque, 0.0, 1.0, 10000.0);
  for (const AxisSample<double>& s : moved)
    inverse.imposed_velocity_rad_s.push_back(s.omega_rotor_rad_s / p.gear_ratio);
  for (const bool at_rotor : {true, false}) {
    inverse.imposed_at_rotor = at_rotor;
    const auto needed = run_axis(p, effects, inverse);
    double worst_Nm = 0.0;
    for (std::size_t n = 1; n < needed.size(); ++n)  // the mean over the period that ends at sample n
      worst_Nm =
          std::max(worst_Nm, std::abs(needed[n].load_torque_Nm / p.gear_ratio - forward.command[n - 1]));
    if (at_rotor)
      EXPECT_LT(worst_Nm, 1e-3 * 0.02);
    else
      EXPECT_GT(worst_Nm, 0.1 * 0.02);
  }
}

}  // namespace
}  // namespace omnihil::test
