#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

TEST(CurrentLowPass, SettlesExponentiallyOnACurrentThatIsImposed) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.3);
  for (std::size_t n = 100; n < in.command.size(); ++n) in.command[n] = 2.0;
  const double tau = 0.02;
  const auto out = run_axis(small_drive(), with({use_of("current_low_pass", {tau})}), in);
  // the mean jumps from sample 100 to 101: a line between them, behind which the low pass settles
  const double first = 2.0 * (1.0 - tau / 1e-3 * (1.0 - std::exp(-1e-3 / tau)));
  for (std::size_t n = 101; n < out.size(); ++n) {
    const double since_s = (static_cast<double>(n) - 101.0) * 1e-3;
    EXPECT_NEAR(out[n].motor_current_A, 2.0 - (2.0 - first) * std::exp(-since_s / tau), 1e-9) << n;
  }
}

// Firmware that smooths once a row, with a time constant of two rows: y += (1 - exp(-P / tau)) (i - y). Of the law (P / tau)^2 / 24
// of the way is lacking, 2 %.
TEST(CurrentLowPass, OfALoopIsItsRecursion) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.3);
  for (std::size_t n = 100; n < in.command.size(); ++n) in.command[n] = 2.0;
  const double tau = 2e-3, period = 1e-3;
  const auto out = run_axis(small_drive(), with({use_of("current_low_pass", {tau, period})}), in);
  const auto continuous = run_axis(small_drive(), with({use_of("current_low_pass", {tau})}), in);
  double y = 0.0;
  for (std::size_t n = 101; n < out.size(); ++n) {
    y += (1.0 - std::exp(-period / tau)) * (2.0 - y);
    EXPECT_NEAR(out[n].motor_current_A, y, 2.0 * period * period / (24.0 * tau * tau)) << n;
  }
  EXPECT_GT(std::abs(continuous[101].motor_current_A - 2.0 * (1.0 - std::exp(-period / tau))), 0.3);
}

TEST(CurrentLowPass, LeavesTheMotionAlone) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto filtered = run_axis(small_drive(), with({use_of("current_low_pass", {0.01})}), in);
  const auto plain = run_axis(small_drive(), nothing(), in);
  double differs = 0.0;
  for (std::size_t n = 0; n < plain.size(); ++n) {
    EXPECT_EQ(filtered[n].velocity_rad_s, plain[n].velocity_rad_s);
    differs = std::max(differs, std::abs(filtered[n].motor_current_A - plain[n].motor_current_A));
  }
  EXPECT_GT(differs, 0.5);
}

}  // namespace
}  // namespace omnihil::test
