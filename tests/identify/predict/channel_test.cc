// How channels are read on every rig.
#include "identify/predict/channel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "sim/law/random.h"

namespace omnihil::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<double> noise(std::size_t n, double sigma) {
  std::vector<double> out;
  for (std::size_t k = 0; k < n; ++k) out.push_back(sigma * gaussian(3, 1, k));
  return out;
}

TEST(Channel, DifferencesFindWhiteNoise) { EXPECT_NEAR(estimate_noise(noise(20000, 0.3)).sigma, 0.3, 0.01); }

// x = a k^2 / 2 has second differences of a and none of third order: a camera's picture of a robot that brakes, a drive that
// its telemetry tells of forty times a second. All that is left is the floor, 80 dB below the signal.
TEST(Channel, ABendFromRowToRowIsNoNoise) {
  std::vector<double> x;
  for (int k = 0; k < 200; ++k) x.push_back(0.5 * 0.002 * k * k);
  double mean = 0.0, square = 0.0;
  for (const double v : x) mean += v / 200.0;
  for (const double v : x) square += (v - mean) * (v - mean) / 200.0;
  EXPECT_NEAR(estimate_noise(x).sigma, 1e-4 * std::sqrt(square), 1e-9);
}

// 3 Hz at 40 rows a second: second differences of A (2 pi f dt)^2, third ones of A (2 pi f dt)^3, their median 0.7 of that.
TEST(Channel, NoiseIsFoundUnderAMotionThatBends) {
  constexpr double kRows_s = 40.0, kMotion_Hz = 3.0, kSize = 1.0, kSigma = 0.02;
  const double step = 2.0 * std::numbers::pi * kMotion_Hz / kRows_s;
  std::vector<double> x = noise(2000, kSigma);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] += kSize * std::sin(step * static_cast<double>(k));
  const double by_second = 1.4826 * 0.7 * kSize * step * step / std::sqrt(6.0);
  const double by_third = 1.4826 * 0.7 * kSize * step * step * step / std::sqrt(20.0);
  EXPECT_GT(by_second, 4.0 * kSigma) << "what it must not be";
  EXPECT_LT(estimate_noise(x).sigma, 1.1 * std::hypot(by_third, kSigma));
  EXPECT_GT(estimate_noise(x).sigma, 0.9 * kSigma);
}

// A speed of counts in a row, 9.77 of them, two thirds of the time at rest. A reading is 9 or 10: its standard deviation is
// sqrt(0.77 x 0.23). Rows of 10 and 11 ms make its smallest step a tenth of a count.
TEST(Channel, ASpeedThatIsCountedIsAsNoisyAsItIsInMotion) {
  std::vector<double> speed;
  double angle = 0.0, before = 0.0;
  for (int k = 0; k < 1800; ++k) {
    const bool moves = k >= 600 && k < 1200;
    const double row_ms = moves && k % 13 == 0 ? 11.0 : 10.0;
    angle += moves ? 0.977 * row_ms : 0.0;
    speed.push_back(10.0 * (std::floor(angle) - before) / row_ms);
    before = std::floor(angle);
  }
  const NoiseEstimate e = estimate_noise(speed);
  EXPECT_LT(e.quantum, 0.2);
  EXPECT_GT(e.sigma, 0.8 * std::sqrt(0.77 * 0.23));
  EXPECT_LT(e.sigma, 1.5 * std::sqrt(0.77 * 0.23));
}

TEST(Channel, NoChannelIsFinerThanItsRounding) {
  std::vector<double> x;
  for (int k = 0; k < 600; ++k) x.push_back(0.5 * std::floor(k / 60.0));
  const NoiseEstimate e = estimate_noise(x);
  EXPECT_DOUBLE_EQ(e.quantum, 0.5);
  EXPECT_NEAR(e.sigma, 0.5 / std::sqrt(12.0), 1e-12);
  ComparedSignal stated;
  set_noise(0.2, e, stated);
  EXPECT_NEAR(stated.noise_sigma, std::hypot(0.2, 0.5 / std::sqrt(12.0)), 1e-12);
  EXPECT_TRUE(stated.noise_is_stated);
}

TEST(Channel, WhatIsMissingHoldsWhatWasKnownBefore) {
  const std::vector<double> x = {kNaN, 2.0, kNaN, 3.0, kNaN};
  EXPECT_EQ(held(&x), (std::vector<double>{2.0, 2.0, 2.0, 3.0, 3.0}));
  EXPECT_EQ(held(&x, 2), (std::vector<double>{2.0, 3.0, 3.0}));
  const std::vector<double> none = {kNaN, kNaN};
  EXPECT_TRUE(held(&none).empty());
  EXPECT_TRUE(held(nullptr).empty());
}

// The mean of 21 has 1 / 21 of the variance; a step of 50 sigma is not noise, and stays where it is.
TEST(Channel, NoiseIsTakenOutOfAnInputAndStepsAreLeft) {
  const std::size_t half[] = {10};
  std::vector<double> x = noise(4000, 0.02);
  for (std::size_t k = 2000; k < x.size(); ++k) x[k] += 1.0;
  const std::vector<double> y = without_noise(x, 0.02, {.half = half, .tolerated = 2.0});
  double square = 0.0;
  for (std::size_t k = 100; k < 1900; ++k) square += y[k] * y[k] / 1800.0;
  EXPECT_NEAR(std::sqrt(square), 0.02 / std::sqrt(21.0), 0.3 * 0.02 / std::sqrt(21.0));
  EXPECT_NEAR(y[1999], 0.0, 0.1);
  EXPECT_NEAR(y[2000], 1.0, 0.1);
  const std::vector<double> few(x.begin(), x.begin() + 20);
  EXPECT_EQ(without_noise(few, 0.02, {.half = half}), few);
}

TEST(Channel, AnAccelerationFromRestBeginsAtRest) {
  std::vector<double> t, rest, moving;
  for (int k = 0; k < 20; ++k) {
    t.push_back(1e-3 * k);
    rest.push_back(0.5 * 40.0 * t.back() * t.back());
    moving.push_back(7.0 * t.back() + rest.back());
  }
  EXPECT_DOUBLE_EQ(first_slope(t, rest, 0, t.size()), 0.0);
  EXPECT_NEAR(first_slope(t, moving, 0, t.size()), 7.0, 1e-9);
  EXPECT_TRUE(std::isnan(first_slope(t, moving, 0, 3)));
}

// A duty that climbs from 0 to 1 in 100 rows passes a twentieth of its range every sixth row, though no row is a step.
TEST(Channel, ASlowClimbIsARowOfSteps) {
  std::vector<double> t, climb, still;
  for (int k = 0; k <= 100; ++k) {
    t.push_back(0.01 * k);
    climb.push_back(0.01 * k);
    still.push_back(k == 50 ? kNaN : 0.3);
  }
  const std::vector<double> since = since_step(t, {still, climb});
  EXPECT_DOUBLE_EQ(since[5], 0.05);
  EXPECT_DOUBLE_EQ(since[6], 0.0);
  EXPECT_NEAR(since[11], 0.05, 1e-12);
  EXPECT_DOUBLE_EQ(since[12], 0.0);
  EXPECT_NEAR(since_step(t, {still})[100], 1.0, 1e-12);
}

}  // namespace
}  // namespace omnihil::test
