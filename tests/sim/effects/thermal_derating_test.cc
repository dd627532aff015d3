#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double limit_at(double rise_K, double full_A, double other_limit_A) {
  BridgePort<double> port;
  port.temperature_rise_K = rise_K;
  port.inverse_current_limit_per_A = 1.0 / other_limit_A;
  const double params[] = {0.1, 80.0, full_A};
  find_effect("thermal_derating")->simulate.bridge(nullptr, params, nullptr, port);
  return 1.0 / port.inverse_current_limit_per_A;
}

// 25 degC + 75 K is 20 K above 80 degC: 5 A - 2 A.
TEST(ThermalDerating, LowersItsLimitAboveItsThreshold) {
  EXPECT_NEAR(limit_at(75.0, 5.0, 100.0), 3.0, 1e-12);
  EXPECT_NEAR(limit_at(55.0 + 1e-9, 5.0, 100.0), 5.0, 1e-9);
}

TEST(ThermalDerating, IsOffWhileTheWindingIsCool) { EXPECT_NEAR(limit_at(20.0, 5.0, 100.0), 100.0, 1e-9); }

TEST(ThermalDerating, LeavesATighterLimitAsItIs) {
  EXPECT_NEAR(limit_at(75.0, 5.0, 2.5), 2.5, 1e-12);
  EXPECT_NEAR(limit_at(75.0, 5.0, 4.0), 3.0, 1e-12);
}

TEST(ThermalDerating, LeavesATwentiethOfItsLimit) { EXPECT_NEAR(limit_at(1000.0, 5.0, 100.0), 0.25, 1e-12); }

TEST(ThermalDerating, StartsAtTheStallCurrentOfTheModelFile) {
  DriveParams<double> drive;
  drive.resistance_ohm = 0.5;
  drive.supply_voltage_V = 24.0;
  EXPECT_NEAR(neutral_use(*find_effect("thermal_derating"), &drive).values[2], 48.0, 1e-12);
  EXPECT_NEAR(neutral_use(*find_effect("thermal_derating"), nullptr).values[2], 20.0, 1e-12);
}

TEST(ThermalDerating, HasDerivativesThatAgreeWithDifferencesOnceItActs) {
  for (const int unknown : {0, 1, 2}) {
    const auto inverse = [&](double step) {
      BridgePort<double> port;
      port.temperature_rise_K = 75.0;
      const double params[] = {0.1 + (unknown == 0 ? step : 0.0), 80.0 + (unknown == 1 ? step : 0.0),
                               5.0 + (unknown == 2 ? step : 0.0)};
      find_effect("thermal_derating")->simulate.bridge(nullptr, params, nullptr, port);
      return port.inverse_current_limit_per_A;
    };
    BridgePort<Jet> port;
    port.temperature_rise_K = Jet(75.0);
    const Jet params[] = {unknown == 0 ? Jet(0.1, 0) : Jet(0.1), unknown == 1 ? Jet(80.0, 0) : Jet(80.0),
                          unknown == 2 ? Jet(5.0, 0) : Jet(5.0)};
    find_effect("thermal_derating")->differentiate.bridge(nullptr, params, nullptr, port);
    const double slope = (inverse(1e-6) - inverse(-1e-6)) / 2e-6;
    EXPECT_NEAR(port.inverse_current_limit_per_A.v[0], slope, 1e-6 * std::abs(slope));
    EXPECT_NE(slope, 0.0);
  }
}

// Signature: in a long hold the flat top of the current falls with the winding's temperature, on the line
// i0 - d (T - T0), while the duty stays.
TEST(ThermalDerating, ShowsAsAFlatTopThatFallsWithTheWindingsTemperature) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  p.current_limit_A = 5.0;
  const auto out = run_axis(p, with({use_of("thermal_derating", {0.05, 60.0, 5.0})}),
                            held(CommandKind::kDuty, 0.9, 60.0, 100.0), {.step_s = 1e-3});
  EXPECT_NEAR(out[20].motor_current_A, 5.0, 1e-6);
  double previous = 5.0;
  for (std::size_t n = 100; n < out.size(); n += 100) {
    const double temperature = 25.0 + out[n].winding_rise_K;
    EXPECT_NEAR(out[n].motor_current_A, 5.0 - 0.05 * std::max(temperature - 60.0, 0.0), 5e-3);
    EXPECT_LE(out[n].motor_current_A, previous + 1e-9);
    previous = out[n].motor_current_A;
  }
  EXPECT_LT(previous, 4.0);
}

}  // namespace
}  // namespace omnihil::test
