#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// Locked: i = D V / R and V = V0 - R_b D i, so V = V0 / (1 + R_b D^2 / R).
TEST(BatterySag, FallsWithTheBusCurrentOfALockedRotor) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  for (const double duty : {1.0, 0.5, -0.5}) {
    const auto out =
        run_axis(p, with({use_of("battery_sag", {0.1})}), held(CommandKind::kDuty, duty, 0.5)).back();
    const double bus = 12.0 / (1.0 + 0.1 * duty * duty / 1.2);
    EXPECT_NEAR(out.bus_voltage_V, bus, 1e-9);
    EXPECT_NEAR(out.motor_current_A, duty * bus / 1.2, 1e-9);
  }
}

TEST(BatterySag, VanishesInTheLimitOfNoResistance) {
  const AxisInput in = excite(Excitation::kSteps, 0.8, 1.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  const auto tiny = run_axis(small_drive(), with({use_of("battery_sag", {1e-9})}), in);
  for (std::size_t n = 0; n < tiny.size(); ++n) {
    EXPECT_NEAR(tiny[n].omega_rotor_rad_s, without[n].omega_rotor_rad_s, 1e-5);
  }
}

TEST(BatterySag, LeavesAMeasuredBusVoltageAlone) {
  AxisInput in = excite(Excitation::kSteps, 0.8, 1.0);
  in.bus_voltage_V.assign(in.time_s.size(), 11.0);
  const auto out = run_axis(small_drive(), with({use_of("battery_sag", {0.5})}), in);
  for (const auto& s : out) EXPECT_EQ(s.bus_voltage_V, 11.0);
}

// Signature: bus voltage over bus current is a line of slope -R_b, both ways, regeneration included.
TEST(BatterySag, ShowsAsALineOfTheBusVoltageOverTheBusCurrent) {
  const AxisInput in = excite(Excitation::kChirp, 0.8, 4.0);
  const auto out = run_axis(small_drive(), with({use_of("battery_sag", {0.1})}), in);
  double ii = 0.0, iv = 0.0, most = 0.0, least = 0.0;
  for (std::size_t n = 1; n < 2500; ++n) {  // slow enough that the period's mean is its end
    ii += out[n].bus_current_A * out[n].bus_current_A;
    iv += out[n].bus_current_A * (out[n].bus_voltage_V - 12.0);
    most = std::max(most, out[n].bus_current_A);
    least = std::min(least, out[n].bus_current_A);
  }
  EXPECT_NEAR(iv / ii, -0.1, 2e-3);
  EXPECT_GT(most, 0.3);
  EXPECT_LT(least, 0.0);
}

}  // namespace
}  // namespace omnihil::test
