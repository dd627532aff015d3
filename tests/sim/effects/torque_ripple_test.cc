#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

WindingPort<double> winding_at(double theta_rad, std::vector<double> params) {
  WindingPort<double> port;
  port.theta_rotor_rad = theta_rad;
  port.torque_constant_Nm_per_A = port.back_emf_V_s_per_rad = 0.0255;
  find_effect("torque_ripple")->simulate.winding(nullptr, params.data(), nullptr, port);
  return port;
}

TEST(TorqueRipple, HasItsCrestAtItsPhase) {
  EXPECT_NEAR(winding_at(0.0, {0.04, 48, 0.0}).torque_constant_Nm_per_A, 0.0255 * 1.04, 1e-15);
  EXPECT_NEAR(winding_at(std::numbers::pi / 48, {0.04, 48, 0.0}).torque_constant_Nm_per_A, 0.0255 * 0.96,
              1e-15);
  EXPECT_NEAR(winding_at(0.01, {0.04, 48, 0.3}).torque_constant_Nm_per_A,
              0.0255 * (1.0 + 0.04 * std::cos(0.48 + 0.3)), 1e-15);
}

// One and the same flux makes torque and back-EMF, so power is kept.
TEST(TorqueRipple, ActsOnTorqueAndBackEmfAlike) {
  for (int n = 0; n < 50; ++n) {
    const auto w = winding_at(0.137 * n, {0.07, 48, 1.0});
    EXPECT_EQ(w.torque_constant_Nm_per_A, w.back_emf_V_s_per_rad);
  }
}

TEST(TorqueRipple, TakesItsOrderFromThePolePairs) {
  DriveParams<double> drive = small_drive();
  drive.pole_pairs = 7;
  EXPECT_EQ(neutral_use(*find_effect("torque_ripple"), &drive).values[1], 42.0);
}

TEST(TorqueRipple, VanishesInTheMeanAtSpeed) {
  const AxisInput in = held(CommandKind::kDuty, 0.8, 2.0);
  const auto without = run_axis(small_drive(), nothing(), in).back();
  const auto with_it = run_axis(small_drive(), with({use_of("torque_ripple", {0.04, 48})}), in).back();
  EXPECT_NEAR(with_it.omega_rotor_rad_s, without.omega_rotor_rad_s, 2e-3 * without.omega_rotor_rad_s);
}

// Signature: torque over the rotor's angle at a held speed: a line at the order in proportion to the current.
TEST(TorqueRipple, ShowsAsALineInProportionToTheCurrent) {
  for (const double current : {0.0, 1.0, 3.0}) {
    AxisInput in = held(CommandKind::kMotorCurrent, current, 10.0);
    in.imposed_velocity_rad_s.assign(in.time_s.size(), 2.0 * std::numbers::pi / 10.0);  // one turn
    const auto out = run_axis(small_drive(), with({use_of("torque_ripple", {0.04, 48, 0.0})}), in);
    for (const int order : {24, 47, 48, 96}) {
      double re = 0, im = 0;
      for (std::size_t n = 1; n < out.size(); ++n) {
        re += out[n].load_torque_Nm * std::cos(order * out[n].theta_rotor_rad);
        im += out[n].load_torque_Nm * std::sin(order * out[n].theta_rotor_rad);
      }
      const double line = 2.0 * std::hypot(re, im) / static_cast<double>(out.size() - 1);
      EXPECT_NEAR(line, order == 48 ? 0.04 * 0.0255 * current : 0.0, 4e-5 * current + 1e-12) << order;
    }
  }
}

}  // namespace
}  // namespace omnihil::test
