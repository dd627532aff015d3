#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

AxisInput ramp(double rate_rad_s2, double duration_s) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, duration_s);
  for (const double t : in.time_s) in.imposed_velocity_rad_s.push_back(rate_rad_s2 * t);
  return in;
}

// Expected value: lags of w in sum follow a ramp exactly w late, whatever the sampling.
TEST(HallSpeedEstimator, IsLateByItsWindowOnARamp) {
  const auto out =
      run_axis(small_drive(), with({use_of("hall_speed_estimator", {48, 0.02})}), ramp(50.0, 1.0));
  EXPECT_NEAR(out.back().velocity_rad_s, 50.0 * (1.0 - 0.02), 1e-6);
}

// Of a sine of period 4 w a mean over w, held for w, leaves (sin(pi / 4) / (pi / 4))^2 = 0.811; a single lag of w 0.537.
TEST(HallSpeedEstimator, ExpectsOfASineWhatAHeldMeanLeaves) {
  constexpr double kWindow_s = 0.02, kPeriod_s = 4.0 * kWindow_s;
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 2.0);
  for (const double t : in.time_s)
    in.imposed_velocity_rad_s.push_back(10.0 * std::sin(2.0 * std::numbers::pi * t / kPeriod_s));
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_estimator", {48, kWindow_s})}), in);
  double largest = 0.0;
  for (const auto& s : out)
    if (s.time_s > 1.0) largest = std::max(largest, std::abs(s.velocity_rad_s));
  const double sinc = std::sin(std::numbers::pi / 4.0) / (std::numbers::pi / 4.0);
  EXPECT_NEAR(largest, 10.0 * sinc * sinc, 0.2);  // six lags: 8.2
}

TEST(HallSpeedEstimator, ShowsTheSpeedInTheLimitOfNoWindow) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_estimator", {48, 1e-12})}), in);
  for (const auto& s : out) EXPECT_NEAR(s.velocity_rad_s, s.omega_rotor_rad_s, 1e-5);
}

TEST(HallSpeedEstimator, TakesItsPulsesFromThePoles) {
  const DriveParams<double> drive = small_drive();
  EXPECT_EQ(neutral_use(*find_effect("hall_speed_estimator"), &drive).values[0], 48.0);  // 6 x 8 pole pairs
}

TEST(HallSpeedEstimator, LeavesTheAngleAlone) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_estimator", {48, 0.02})}), in);
  for (const auto& s : out) EXPECT_EQ(s.position_rad, s.theta_rotor_rad);
}

// Signature: a staircase of whole pulses per window, 2 pi / (n w), held for a window; right in the mean.
TEST(HallSpeedEstimator, ShowsAsAStaircaseOfPulsesPerWindow) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 4.0);
  const double speed = 17.0;
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed);
  in.noise_seed = 1;  // what the firmware gives, not its expected value
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_estimator", {48, 0.02})}), in);
  const double height = 2.0 * std::numbers::pi / (48 * 0.02);
  double mean = 0.0;
  int changes = 0;
  std::set<long> levels;
  for (std::size_t n = 21; n < out.size(); ++n) {
    const double level = out[n].velocity_rad_s / height;
    EXPECT_NEAR(level, std::round(level), 1e-6);
    levels.insert(std::lround(level));
    mean += out[n].velocity_rad_s / static_cast<double>(out.size() - 21);
    if (out[n].velocity_rad_s != out[n - 1].velocity_rad_s) ++changes;
  }
  EXPECT_EQ(levels, (std::set<long>{2, 3}));  // 17 / 6.545 = 2.6
  EXPECT_NEAR(mean, speed, 0.01 * speed);
  EXPECT_LE(changes, 200);  // at most once per window
  EXPECT_GE(changes, 50);
}

}  // namespace
}  // namespace omnihil::test
