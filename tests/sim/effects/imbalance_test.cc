#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double torque_at(double theta_rotor_rad, std::vector<double> params) {
  TorquePort<double> port;
  port.theta_rotor_rad = theta_rotor_rad;
  port.gear_ratio = 3.0;
  port.theta_output_rad = theta_rotor_rad / 3.0;
  find_effect("imbalance")->simulate.torque(nullptr, params.data(), nullptr, port);
  return port.tau_Nm;
}

TEST(Imbalance, PullsItsHeavySideDown) {
  EXPECT_NEAR(torque_at(std::numbers::pi / 2, {0.002, 0.0}), -0.002, 1e-15);
  EXPECT_NEAR(torque_at(0.3, {0.002, 0.5}), -0.002 * std::sin(0.8), 1e-15);
}

// At the rotor, whatever the gear: the same rotor angle a turn later, the same torque.
TEST(Imbalance, RepeatsWithTheRotorNotWithTheOutput) {
  EXPECT_NEAR(torque_at(0.3 + 2.0 * std::numbers::pi, {0.002, 0.5}), torque_at(0.3, {0.002, 0.5}), 1e-15);
}

TEST(Imbalance, VanishesInTheMeanAtSpeed) {
  const AxisInput in = held(CommandKind::kDuty, 0.8, 2.0);
  const auto without = run_axis(small_drive(), nothing(), in).back();
  const auto with_it = run_axis(small_drive(), with({use_of("imbalance", {0.002, 0.0})}), in).back();
  EXPECT_NEAR(with_it.omega_rotor_rad_s, without.omega_rotor_rad_s, 1e-3 * without.omega_rotor_rad_s);
}

// Amplitude of the speed at the rotor's own order.
double ripple(const EffectSet<double>& effects, double torque_Nm, double from_rad_s) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, torque_Nm, 2.0 * std::numbers::pi / from_rad_s, 20000.0);
  in.initial_velocity_rad_s = from_rad_s;
  const auto out = run_axis(p, effects, in);
  double most = -1e9, least = 1e9;
  for (const auto& s : out) {
    most = std::max(most, s.omega_rotor_rad_s);
    least = std::min(least, s.omega_rotor_rad_s);
  }
  return 0.5 * (most - least);
}

// Signature: J w^2 / 2 - A cos(theta) is kept, so over a turn w swings by A / (J w): as 1 / speed.
TEST(Imbalance, ShowsAsASpeedRippleThatFallsWithSpeed) {
  const double j = inertia_at_rotor(small_drive());
  const auto effects = with({use_of("imbalance", {0.002, 0.0})});
  for (const double w : {100.0, 200.0, 400.0}) {
    EXPECT_NEAR(ripple(effects, 0.0, w), 0.002 / (j * w), 0.01 * 0.002 / (j * w)) << w;
  }
}

}  // namespace
}  // namespace omnihil::test
