#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double torque_at(const EffectUse& use, double theta_rad) {
  TorquePort<double> port;
  port.theta_rotor_rad = theta_rad;
  use.entry->simulate.torque(nullptr, law_params<double>(*use.entry, use.values).data(), nullptr, port);
  return port.tau_Nm;
}

TEST(Cogging, GivesItsAmplitudeAQuarterPeriodAfterItsZero) {
  const EffectUse use = use_of("cogging", {0.004, 48, 0.0});
  EXPECT_DOUBLE_EQ(torque_at(use, 0.0), 0.0);
  EXPECT_NEAR(torque_at(use, std::numbers::pi / 2 / 48), 0.004, 1e-15);
}

TEST(Cogging, AddsHarmonicsAtMultiplesOfItsOrder) {
  EffectUse use = use_of("cogging", {0.004, 6, 0.0});
  use.values[static_cast<std::size_t>(find_param(*use.entry->info, "amplitude_12"))] = 0.001;
  use.values[static_cast<std::size_t>(find_param(*use.entry->info, "phase_12"))] = 0.5;
  EXPECT_NEAR(torque_at(use, 0.1), 0.004 * std::sin(0.6) + 0.001 * std::sin(7.2 + 0.5), 1e-15);
}

TEST(Cogging, TakesItsOrderFromPolesAndSlots) {
  DriveParams<double> drive = small_drive();
  EXPECT_EQ(neutral_use(*find_effect("cogging"), &drive).values[1], 48.0);  // lcm(16, 12)
  drive.pole_pairs = 12;
  drive.slots = 18;
  EXPECT_EQ(neutral_use(*find_effect("cogging"), &drive).values[1], 72.0);  // lcm(24, 18)
}

// Far above the resonance of rotor and magnets its torque averages out.
TEST(Cogging, VanishesInTheMeanAtSpeed) {
  const AxisInput in = held(CommandKind::kDuty, 0.8, 2.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  const auto with_it = run_axis(small_drive(), with({use_of("cogging", {0.004, 48})}), in);
  EXPECT_NEAR(with_it.back().omega_rotor_rad_s, without.back().omega_rotor_rad_s,
              2e-3 * without.back().omega_rotor_rad_s);
}

// Signature: turning slowly at a held speed, the bench's torque over the rotor's angle is one line at the
// order.
TEST(Cogging, ShowsAsALineAtItsOrderInTheTorqueOverTheAngle) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 10.0);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), 2.0 * std::numbers::pi / 10.0);  // one turn
  const auto out = run_axis(small_drive(), with({use_of("cogging", {0.004, 48, 0.0})}), in);
  const auto line = [&](int order) {
    double re = 0, im = 0;
    for (std::size_t n = 1; n < out.size(); ++n) {
      re += out[n].load_torque_Nm * std::cos(order * out[n].theta_rotor_rad);
      im += out[n].load_torque_Nm * std::sin(order * out[n].theta_rotor_rad);
    }
    return 2.0 * std::hypot(re, im) / static_cast<double>(out.size() - 1);
  };
  EXPECT_NEAR(line(48), 0.004, 4e-5);
  for (const int other : {1, 24, 47, 49, 96}) EXPECT_LT(line(other), 2e-5) << other;
}

}  // namespace
}  // namespace omnihil::test
