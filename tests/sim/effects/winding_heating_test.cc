#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr double kAlpha = 0.00393, kRw = 4.0, kCw = 0.5, kRh = 6.0, kCh = 10.0;

DriveParams<double> locked() {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  return p;
}

// One mass, constant loss (coefficient 0 would be neutral, so a tiny one): T = P R (1 - exp(-t / (R C))).
TEST(WindingHeating, FollowsTheExponentialOfOneMass) {
  const AxisInput in = held(CommandKind::kMotorCurrent, 2.0, 10.0);
  const auto out = run_axis(locked(), with({use_of("winding_heating", {1e-12, kRw, kCw, 0.0, kCh})}), in);
  const double loss_W = 1.2 * 4.0;
  for (const std::size_t n : {500u, 2000u, 10000u}) {
    const double expected = loss_W * kRw * (1.0 - std::exp(-out[n].time_s / (kRw * kCw)));
    EXPECT_NEAR(out[n].winding_rise_K, expected, 2e-4 * expected);
  }
}

// Settled under a constant current: T = P (R_w + R_h), P = R (1 + a T) i^2.
TEST(WindingHeating, SettlesWhereTheLossFlowsThroughBothMasses) {
  const double i = 1.5;
  const auto out = run_axis(locked(), with({use_of("winding_heating", {kAlpha, kRw, kCw, kRh, 2.0})}),
                            held(CommandKind::kMotorCurrent, i, 300.0, 20.0));
  const double cold_K = 1.2 * i * i * (kRw + kRh);
  EXPECT_NEAR(out.back().winding_rise_K, cold_K / (1.0 - kAlpha * cold_K), 1e-6);
}

TEST(WindingHeating, KeepsTheHousingColdWhereItHasNoResistance) {
  const AxisInput in = held(CommandKind::kMotorCurrent, 2.0, 5.0);
  const auto one = run_axis(locked(), with({use_of("winding_heating", {kAlpha, kRw, kCw, 0.0, kCh})}), in);
  const auto two = run_axis(locked(), with({use_of("winding_heating", {kAlpha, kRw, kCw, 1e-9, kCh})}), in);
  for (std::size_t n = 0; n < one.size(); ++n) {
    EXPECT_NEAR(two[n].winding_rise_K, one[n].winding_rise_K, 1e-6);
  }
}

// The slow mass: two time constants, the roots of the two-mass system.
TEST(WindingHeating, CoolsWithTheTwoTimeConstantsOfTwoMasses) {
  AxisInput in = held(CommandKind::kMotorCurrent, 3.0, 200.0, 50.0);
  for (std::size_t n = in.time_s.size() / 2; n < in.time_s.size(); ++n) in.command[n] = 0.0;
  const auto out = run_axis(locked(), with({use_of("winding_heating", {1e-12, kRw, kCw, kRh, kCh})}), in);
  // s^2 + (1/(R_w C_w) + 1/(R_w C_h) + 1/(R_h C_h)) s + 1/(R_w C_w R_h C_h) = 0
  const double sum = 1.0 / (kRw * kCw) + 1.0 / (kRw * kCh) + 1.0 / (kRh * kCh);
  const double product = 1.0 / (kRw * kCw * kRh * kCh);
  const double slow = 0.5 * (sum - std::sqrt(sum * sum - 4.0 * product));
  const std::size_t a = 6500, b = 9500;  // the fast part is gone 30 s after switching off
  EXPECT_NEAR(out[b].winding_rise_K / out[a].winding_rise_K,
              std::exp(-slow * (out[b].time_s - out[a].time_s)), 1e-4);
}

TEST(WindingHeating, NeverFallsBelowAmbient) {
  const auto out = run_axis(small_drive(), with({typical_use(*find_effect("winding_heating"))}),
                            excite(Excitation::kPrbs, 0.9, 5.0));
  for (std::size_t n = 1; n < out.size(); ++n) EXPECT_GE(out[n].winding_rise_K, 0.0);
}

// Signature: at a hold, voltage over current rises with time by the winding's rise, and falls when it rests.
TEST(WindingHeating, ShowsAsARisingRatioOfVoltageToCurrent) {
  AxisInput in = held(CommandKind::kDuty, 0.3, 60.0, 200.0);
  for (std::size_t n = 0; n < in.time_s.size(); ++n) {
    if (in.time_s[n] > 30.0 && in.time_s[n] < 58.0) in.command[n] = 0.0;  // a rest of 28 s
  }
  const auto out = run_axis(locked(), with({use_of("winding_heating", {kAlpha, kRw, 2.0, 0.0, kCh})}), in);
  const auto ratio = [&](double t) {
    const auto& s = out[static_cast<std::size_t>(t * 200.0)];
    EXPECT_NEAR(s.motor_voltage_V / s.motor_current_A, 1.2 * (1.0 + kAlpha * s.winding_rise_K), 1e-4);
    return s.motor_voltage_V / s.motor_current_A;
  };
  const double cold = ratio(0.1), warm = ratio(29.9), rested = ratio(58.1);
  EXPECT_GT(warm, 1.1 * cold);
  EXPECT_LT(rested, cold + 0.1 * (warm - cold));
}

}  // namespace
}  // namespace omnihil::test
