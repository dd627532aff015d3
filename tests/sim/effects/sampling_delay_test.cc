#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

TEST(SamplingDelay, GivesWhatStoodWholeSamplesEarlier) {
  const AxisInput in = excite(Excitation::kPrbs, 0.6, 1.0);
  const auto now = run_axis(small_drive(), nothing(), in);
  const auto old = run_axis(small_drive(), with({use_of("sampling_delay", {0.004})}), in);
  for (std::size_t n = 4; n < now.size(); ++n) {
    EXPECT_NEAR(old[n].position_rad, now[n - 4].position_rad, 1e-6);
    EXPECT_NEAR(old[n].velocity_rad_s, now[n - 4].velocity_rad_s, 1e-6);
  }
}

TEST(SamplingDelay, VanishesInTheLimit) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto now = run_axis(small_drive(), nothing(), in);
  const auto old = run_axis(small_drive(), with({use_of("sampling_delay", {1e-9})}), in);
  for (std::size_t n = 0; n < now.size(); ++n) EXPECT_NEAR(old[n].position_rad, now[n].position_rad, 1e-6);
}

TEST(SamplingDelay, LeavesTheMotionAlone) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto now = run_axis(small_drive(), nothing(), in);
  const auto old = run_axis(small_drive(), with({use_of("sampling_delay", {0.003})}), in);
  for (std::size_t n = 0; n < now.size(); ++n) {
    EXPECT_NEAR(old[n].omega_rotor_rad_s, now[n].omega_rotor_rad_s, 1e-9);
  }
}

TEST(SamplingDelay, LeavesVisionAlone) {
  TimingPort<double> port;
  port.what = Stamped::kVision;
  const double delay_s = 0.003;
  find_effect("sampling_delay")->simulate.timing(nullptr, &delay_s, nullptr, port);
  EXPECT_EQ(port.age_s, 0.0);
}

// Signature: of a motion that the bench imposes the measured speed lags by omega d at the same gain.
TEST(SamplingDelay, ShowsAsAPhaseInProportionToTheFrequencyOfAnImposedMotion) {
  const double d = 0.003;
  for (const double f : {5.0, 10.0, 20.0}) {
    AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 2.0);
    for (const double t : in.time_s) in.imposed_velocity_rad_s.push_back(10.0 * std::sin(2.0 * M_PI * f * t));
    const auto out = run_axis(small_drive(), with({use_of("sampling_delay", {d})}), in);
    double re = 0.0, im = 0.0;
    for (std::size_t n = 1000; n < 2000; ++n) {  // whole periods
      re += out[n].velocity_rad_s * std::cos(2.0 * M_PI * f * in.time_s[n]) / 500.0;
      im += out[n].velocity_rad_s * std::sin(2.0 * M_PI * f * in.time_s[n]) / 500.0;
    }
    EXPECT_NEAR(-std::atan2(re, im), 2.0 * M_PI * f * d, 2e-3) << f;
    EXPECT_NEAR(std::hypot(re, im), 10.0, 0.02) << f;
  }
}

}  // namespace
}  // namespace omnihil::test
