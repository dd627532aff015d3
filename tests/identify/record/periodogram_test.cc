// The noise of a torque that a controller commands: what the motion follows is none.
#include "identify/record/periodogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "identify/record/band_noise.h"
#include "identify/record/filter.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kRate_Hz = 500.0;
constexpr double kBand = 0.2;

std::vector<double> white(double sigma, std::size_t n, std::uint64_t seed) {
  std::vector<double> x;
  for (std::size_t k = 0; k < n; ++k) x.push_back(sigma * gaussian(seed, 1, k));
  return x;
}

std::vector<double> sum(std::vector<double> x, const std::vector<double>& y) {
  for (std::size_t k = 0; k < x.size(); ++k) x[k] += y[k];
  return x;
}

// Speed of a rotor that a torque turns against viscous friction: w' = 500 u - 5 w.
std::vector<double> speed_by(const std::vector<double>& torque) {
  std::vector<double> w(1, 0.0);
  for (std::size_t k = 0; k + 1 < torque.size(); ++k)
    w.push_back(w.back() + (500.0 * torque[k] - 5.0 * w.back()) / kRate_Hz);
  return w;
}

TEST(Periodogram, OfWhiteNoiseIsItsVariance) {
  const std::vector<double> x = white(0.3, 8192, 1);
  const Periodogram p = periodogram_of(x, segment_length(x.size()));
  double mean = 0.0;
  for (std::size_t k = 2; k + 1 < p.power.size(); ++k)
    mean += p.power[k] / p.window_square / static_cast<double>(p.power.size() - 3);
  EXPECT_NEAR(mean, 0.09, 0.09 * 0.05);
}

TEST(IncoherentSigma, OfWhiteNoiseIsIts) {
  for (const std::size_t n : {300U, 1000U, 20000U}) {
    const std::vector<double> x = white(0.02, n, 3), y = white(1.0, n, 4);
    EXPECT_NEAR(incoherent_sigma(x, y, kBand), 0.02, 0.02 * 4.0 / std::sqrt(static_cast<double>(n)))
        << n << " samples";
  }
}

TEST(IncoherentSigma, WhatTheMotionFollowsIsNoNoise) {
  // Commanded up to 160 Hz, compared up to 50.
  const std::vector<double> asked = zero_phase(butterworth(4, 160.0, kRate_Hz), white(0.2, 6000, 5));
  const std::vector<double> told = sum(asked, white(0.01, asked.size(), 6));
  const std::vector<double> speed = sum(speed_by(asked), white(0.003, asked.size(), 7));
  const double all_above = white_noise(told, zero_phase(butterworth(4, 50.0, kRate_Hz), told), kBand);
  EXPECT_GT(all_above, 0.08);
  EXPECT_NEAR(incoherent_sigma(told, speed, kBand), 0.01, 0.002);
}

TEST(IncoherentSigma, OfTooShortARecordIsNone) {
  EXPECT_TRUE(std::isnan(incoherent_sigma(white(1.0, 100, 1), white(1.0, 100, 2), kBand)));
  EXPECT_TRUE(std::isnan(incoherent_sigma(std::vector<double>(1000, 0.0), white(1.0, 1000, 2), kBand)));
}

}  // namespace
}  // namespace omnihil
