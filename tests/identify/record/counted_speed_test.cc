#include "identify/record/counted_speed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kPulse_rad = 2.0 * M_PI / 42.0;
constexpr double kWindow_s = 0.008;
constexpr double kPeriod_s = 1e-3;

std::vector<double> clock(std::size_t n) {
  std::vector<double> t(n);
  for (std::size_t k = 0; k < n; ++k) t[k] = static_cast<double>(k) * kPeriod_s;
  return t;
}

// Pulses of the last eight samples of a motor that swings.
std::vector<double> counted(std::size_t n) {
  const auto pulses = [](double t) { return std::floor(20.0 * (1.0 - std::cos(3.0 * t)) / kPulse_rad); };
  std::vector<double> v(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) * kPeriod_s;
    v[k] = (pulses(t) - pulses(std::max(0.0, t - kWindow_s))) * kPulse_rad / kWindow_s;
  }
  return v;
}

TEST(CountedSpeed, IsKnownByItsStepAndTheMotorsPulses) {
  const CountedSpeed c = counted_speed(counted(20000), kPulse_rad / kWindow_s, kPeriod_s, kPulse_rad);
  EXPECT_NEAR(c.window_s, kWindow_s, 1e-9);
  EXPECT_NEAR(c.noise_sigma(), kPulse_rad / kWindow_s / std::sqrt(6.0), 1e-9);
}

TEST(CountedSpeed, IsKnownWhereTheWindowIsHeld) {
  std::vector<double> v = counted(20000);
  for (std::size_t k = 0; k < v.size(); ++k) v[k] = v[k - k % 8];
  EXPECT_NEAR(counted_speed(v, kPulse_rad / kWindow_s, kPeriod_s, kPulse_rad).window_s, kWindow_s, 1e-9);
}

// A step of 18.7 rad/s, written in whole ones: 19, 37, 56, … differ by 18 and 19; or in whole turns per minute, read in rad/s.
TEST(CountedSpeed, IsKnownBehindTheDecimalsOfAFile) {
  for (const double unit : {1.0, 2.0 * M_PI / 60.0}) {
    std::vector<double> v = counted(20000);
    for (double& x : v) x = unit * std::round(x / unit);
    const double quantum = unit * std::floor(kPulse_rad / kWindow_s / unit);
    EXPECT_NEAR(counted_speed(v, quantum, kPeriod_s, kPulse_rad).window_s, kWindow_s, 1e-5) << unit;
  }
}

TEST(CountedSpeed, IsNotSeenWithoutAStepOrPolePairs) {
  const std::vector<double> v = counted(20000);
  EXPECT_EQ(counted_speed(v, 0.0, kPeriod_s, kPulse_rad).window_s, 0.0);
  EXPECT_EQ(counted_speed(v, kPulse_rad / kWindow_s, kPeriod_s, 0.0).window_s, 0.0);
}

// The same motion, differenced from an encoder whose count over a sample is a Hall pulse over 10 and 48 ms.
TEST(CountedSpeed, IsNotSeenInTheDifferencesOfAnEncoder) {
  for (const double counts_per_pulse : {10.0, 48.0}) {
    const double count_rad = kPulse_rad / counts_per_pulse, step = count_rad / kPeriod_s;
    std::vector<double> v(20000, 0.0);
    const auto counts = [&](std::size_t k) {
      return std::floor(20.0 * (1.0 - std::cos(3.0 * static_cast<double>(k) * kPeriod_s)) / count_rad);
    };
    for (std::size_t k = 1; k < v.size(); ++k) v[k] = (counts(k) - counts(k - 1)) * step;
    EXPECT_EQ(counted_speed(v, step, kPeriod_s, kPulse_rad).window_s, 0.0) << counts_per_pulse;
  }
}

// ... and rounded to the very step that a window would make.
TEST(CountedSpeed, IsNotSeenWhereTheStepIsOfANumberFormat) {
  const double step = kPulse_rad / kWindow_s;
  for (const double noise : {0.0, 1.0}) {
    std::vector<double> v(20000);
    for (std::size_t k = 0; k < v.size(); ++k) {
      const double speed =
          60.0 * std::sin(3.0 * static_cast<double>(k) * kPeriod_s) + noise * step * gaussian(1, 2, k);
      v[k] = step * std::round(speed / step);
    }
    EXPECT_EQ(counted_speed(v, step, kPeriod_s, kPulse_rad).window_s, 0.0) << noise;
  }
}

TEST(CountedSpeed, IsNotSeenWhereReadingsLieBetweenTheSteps) {
  std::vector<double> v = counted(20000);
  v[1234] += 0.3 * kPulse_rad / kWindow_s;
  EXPECT_EQ(counted_speed(v, kPulse_rad / kWindow_s, kPeriod_s, kPulse_rad).window_s, 0.0);
}

// The noise has the stated size, and what it does to the angle never exceeds a pulse.
TEST(CountedSpeed, NoiseHasItsSizeAndItsIntegralIsBounded) {
  const CountedSpeed c{.window_s = kWindow_s, .pulse_rad = kPulse_rad};
  std::vector<double> v(20000);
  for (std::size_t k = 0; k < v.size(); ++k)
    v[k] = 60.0 + 40.0 * std::sin(1.7 * static_cast<double>(k) * kPeriod_s);
  const std::vector<double> truth = v;
  add_counting_noise(c, clock(v.size()), v, 0.37);
  double square = 0.0, sum = 0.0, most = 0.0;
  for (std::size_t k = 0; k < v.size(); ++k) {
    square += (v[k] - truth[k]) * (v[k] - truth[k]) / static_cast<double>(v.size());
    sum += (v[k] - truth[k]) * kPeriod_s;
    most = std::max(most, std::abs(sum));
  }
  EXPECT_NEAR(std::sqrt(square), c.noise_sigma(), 0.1 * c.noise_sigma());
  EXPECT_LE(most, 1.05 * kPulse_rad);
}

// A counted record: its own readings, but for the lag of the window.
TEST(CountedSpeed, NoiseOnTheMeanOverTheWindowIsTheReading) {
  const std::vector<double> readings = counted(4000);
  const auto angle = [](double t) { return 20.0 * (1.0 - std::cos(3.0 * t)); };
  std::vector<double> speed(readings.size(), 0.0);
  for (std::size_t k = 1; k < speed.size(); ++k)
    speed[k] = (angle(static_cast<double>(k) * kPeriod_s) - angle(static_cast<double>(k - 1) * kPeriod_s)) /
               kPeriod_s;
  std::vector<double> noisy = speed;
  add_counting_noise({.window_s = kWindow_s, .pulse_rad = kPulse_rad}, clock(speed.size()), noisy, 0.0);
  for (std::size_t k = 8; k < speed.size(); ++k) {
    double mean = 0.0;
    for (std::size_t i = 0; i < 8; ++i) mean += speed[k - i] / 8.0;
    // roundings at the very edge of a pulse may fall to either side
    const double off = std::abs(noisy[k] - speed[k] + mean - readings[k]);
    EXPECT_LT(std::min(off, std::abs(off - kPulse_rad / kWindow_s)), 1e-6) << k;
  }
}

}  // namespace
}  // namespace omnihil
