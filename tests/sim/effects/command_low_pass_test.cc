#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

AxisInput current_step(double at_s, double value) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.2);
  for (std::size_t n = 0; n < in.time_s.size(); ++n)
    in.command[n] = in.time_s[n] >= at_s - 1e-9 ? value : 0.0;
  return in;
}

// The mean current of each period after a step of an imposed current: that of 1 - exp(-t / tau).
TEST(CommandLowPass, MakesAnExponentialOfAStep) {
  const double tau = 0.01, step = 1e-3;
  const auto out =
      run_axis(small_drive(), with({use_of("command_low_pass", {tau})}), current_step(0.05, 2.0));
  for (std::size_t n = 51; n < out.size(); ++n) {
    const double from = (static_cast<double>(n) - 51.0) * step;
    const double mean = 1.0 - tau / step * (std::exp(-from / tau) - std::exp(-(from + step) / tau));
    EXPECT_NEAR(out[n].motor_current_A, 2.0 * mean, 1e-9) << n;
  }
}

// What differs from a delay by the same time: the gain at high frequencies.
TEST(CommandLowPass, LowersTheGainWhereADelayDoesNot) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 1.0);
  const double omega = 2.0 * 3.14159265358979 * 20.0, tau = 0.01;
  for (std::size_t n = 0; n < in.time_s.size(); ++n) in.command[n] = std::sin(omega * in.time_s[n]);
  const auto rms = [](const std::vector<AxisSample<double>>& out) {
    double sum = 0.0;
    for (std::size_t n = 500; n < 1000; ++n) sum += out[n].motor_current_A * out[n].motor_current_A;
    return std::sqrt(sum / 500.0);
  };
  const double before = rms(run_axis(small_drive(), nothing(), in));
  const double after = rms(run_axis(small_drive(), with({use_of("command_low_pass", {tau})}), in));
  EXPECT_NEAR(after / before, 1.0 / std::sqrt(1.0 + omega * omega * tau * tau), 2e-3);
}

TEST(CommandLowPass, BeginsWithTheFirstCommandAsIfItHadAlwaysBeen) {
  const AxisInput in = held(CommandKind::kMotorCurrent, 1.5, 0.1);
  const auto out = run_axis(small_drive(), with({use_of("command_low_pass", {0.05})}), in);
  for (const auto& s : out) EXPECT_NEAR(s.motor_current_A, s.time_s > 0.0 ? 1.5 : 0.0, 1e-12);
}

TEST(CommandLowPass, BeginsWithWhatWasAskedBeforeWhereThatIsKnown) {
  AxisInput in = held(CommandKind::kMotorCurrent, 1.5, 0.3);
  in.command_before = 0.0;
  const auto out = run_axis(small_drive(), with({use_of("command_low_pass", {0.05})}), in);
  EXPECT_LT(out[1].motor_current_A, 0.02 * 1.5);
  EXPECT_NEAR(out.back().motor_current_A, 1.5 * (1.0 - std::exp(-0.3 / 0.05)), 1e-3);
}

// Firmware that smooths once a row: y += (1 - exp(-P / tau)) (u - y), held until the next row. Its mean over each row is that
// of the law, but for (P / tau)^2 / 24 of the way.
TEST(CommandLowPass, OfALoopIsThatOfItsRecursionInTheMean) {
  const double tau = 0.008, period = 1e-3;
  const auto out =
      run_axis(small_drive(), with({use_of("command_low_pass", {tau, period})}), current_step(0.05, 2.0));
  const auto continuous =
      run_axis(small_drive(), with({use_of("command_low_pass", {tau})}), current_step(0.05, 2.0));
  double y = 0.0, apart = 0.0;
  for (std::size_t n = 51; n < out.size(); ++n) {
    y += (1.0 - std::exp(-period / tau)) * (2.0 - y);
    EXPECT_NEAR(out[n].motor_current_A, y, 2.0 * period * period / (24.0 * tau * tau)) << n;
    apart = std::max(apart, std::abs(continuous[n].motor_current_A - y));
  }
  EXPECT_GT(apart, 0.1);  // half a period early: P / 2 tau of the way
}

// The sensitivity of a search begins at no smoothing and no loop: that of a delay.
TEST(CommandLowPass, HasADerivativeWithoutSmoothing) {
  const EffectUse use = use_of("command_low_pass", {0.0, 0.0});
  const double step = 1e-3, small = 1e-9;
  const auto late =
      run_axis(small_drive(), with({use_of("command_low_pass", {small})}), current_step(0.05, 2.0));
  const auto plain = run_axis(small_drive(), with({use}), current_step(0.05, 2.0));
  EXPECT_NEAR((plain[51].motor_current_A - late[51].motor_current_A) / small, 2.0 / step, 1.0);
  EXPECT_NEAR(plain[51].motor_current_A, 2.0, 1e-12);
}

}  // namespace
}  // namespace omnihil::test
