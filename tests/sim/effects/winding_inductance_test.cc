#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveParams<double> locked() {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  return p;
}

AxisInput step_of_duty() { return held(CommandKind::kDuty, 0.2, 0.005, 20000.0); }

// i = u / R (1 - exp(-R t / L)), L = model + effect; the sample holds the mean of its period.
TEST(WindingInductance, AddsToTheModelsInductance) {
  const double l = 5.6e-4 + 4e-4, r = 1.2, h = 5e-5;
  const auto out = run_axis(locked(), with({use_of("winding_inductance", {4e-4})}), step_of_duty());
  for (std::size_t n = 1; n < out.size(); ++n) {
    const double t = out[n].time_s;
    const double mean = (std::exp(-r * (t - h) / l) - std::exp(-r * t / l)) * l / (r * h);
    EXPECT_NEAR(out[n].motor_current_A, 2.0 * (1.0 - mean), 1e-9);
  }
}

TEST(WindingInductance, LeavesTheModelsInTheLimit) {
  const auto without = run_axis(locked(), nothing(), step_of_duty());
  const auto tiny = run_axis(locked(), with({use_of("winding_inductance", {1e-12})}), step_of_duty());
  for (std::size_t n = 0; n < without.size(); ++n) {
    EXPECT_NEAR(tiny[n].motor_current_A, without[n].motor_current_A, 1e-7);
  }
}

TEST(WindingInductance, IsTheSameAsTheBaseParameter) {
  DriveParams<double> p = small_drive();
  const AxisInput in = excite(Excitation::kPrbs, 0.7, 1.0);
  const auto effect = run_axis(p, with({use_of("winding_inductance", {3e-4})}), in);
  p.inductance_H += 3e-4;
  const auto base = run_axis(p, nothing(), in);
  for (std::size_t n = 0; n < base.size(); ++n) {
    EXPECT_NEAR(effect[n].omega_rotor_rad_s, base[n].omega_rotor_rad_s, 1e-8);
  }
}

// It changes how a current comes about, not where it settles.
TEST(WindingInductance, LeavesSettledValues) {
  const AxisInput in = held(CommandKind::kDuty, 0.5, 3.0);
  EXPECT_NEAR(
      run_axis(small_drive(), with({use_of("winding_inductance", {1e-3})}), in).back().omega_rotor_rad_s,
      run_axis(small_drive(), nothing(), in).back().omega_rotor_rad_s, 1e-9);
}

// Signature: at a locked rotor the current's gain over frequency is 1 / sqrt(R^2 + (2 pi f L)^2), and it
// lags.
TEST(WindingInductance, ShowsAsAGainThatFallsWithFrequency) {
  const double l = 5.6e-4 + 5e-4, r = 1.2;
  for (const double f : {100.0, 250.0, 500.0}) {
    AxisInput in = held(CommandKind::kDuty, 0.0, 0.2, 20000.0);
    for (std::size_t n = 0; n < in.time_s.size(); ++n) {
      in.command[n] = 0.2 * std::sin(2.0 * std::numbers::pi * f * in.time_s[n]);
    }
    const auto out = run_axis(locked(), with({use_of("winding_inductance", {5e-4})}), in);
    double re = 0, im = 0;
    for (std::size_t n = 2001; n <= 4000; ++n) {
      // command held from n - 1 to n, current its mean over the same time: both at the same middle
      const double angle = 2.0 * std::numbers::pi * f * (out[n].time_s - 5e-5);
      re += out[n].motor_current_A * std::sin(angle), im += out[n].motor_current_A * std::cos(angle);
    }
    const double x = 2.0 * std::numbers::pi * f * l;
    EXPECT_NEAR(std::hypot(re, im) / 1000.0, 2.4 / std::hypot(r, x), 0.005 * 2.4 / r) << f;
    EXPECT_NEAR(std::atan2(-im, re), std::atan2(x, r), 0.01) << f;
  }
}

}  // namespace
}  // namespace omnihil::test
