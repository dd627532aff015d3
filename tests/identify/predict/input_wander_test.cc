#include "identify/predict/input_wander.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kPeriod_s = 1e-3, kLongest_s = 0.25, kShortest_s = kLongest_s / 16.0, kRounding_rad = 4e-4;
constexpr std::size_t kSamples = 100000;

ComparedSignal counts() {
  ComparedSignal c;
  c.noise_sigma = std::sqrt(2.0) * kRounding_rad / kPeriod_s;
  c.whitening_s = kLongest_s;
  for (std::size_t k = 0; k < kSamples; ++k) c.time_s.push_back(kPeriod_s * static_cast<double>(k));
  return c;
}

std::vector<double> white(double sigma) {
  std::vector<double> out;
  for (std::size_t k = 0; k < kSamples; ++k) out.push_back(sigma * gaussian(1, 2, k));
  return out;
}

TEST(InputWander, RoundingAloneKeepsTheLongestLeak) {
  const ComparedSignal signal = counts();
  const Wander none{.signal = &signal, .change = std::vector<double>(1000, 0.0)};
  const Whitening best = whitening_beside({&none, 1}, kLongest_s, kShortest_s);
  EXPECT_DOUBLE_EQ(best.time_constant_s, kLongest_s);
  EXPECT_NEAR(best.sigma, kRounding_rad * std::sqrt(2.0 / (1.0 + std::exp(-kPeriod_s / kLongest_s))), 1e-12);
}

// White noise w of the speed through the leak a has (w dt)^2 / (1 - a^2), rounding e of the position 2 e^2 / (1 + a): the
// same at a time constant where w dt = e sqrt(2 (1 - a)).
TEST(InputWander, TheLeakIsTheLongestThroughWhichTheWanderIsNoMoreThanTheRounding) {
  const ComparedSignal signal = counts();
  for (const double tau_s : {kLongest_s / 2.0, kLongest_s / 8.0}) {
    const double a = std::exp(-kPeriod_s / tau_s);
    const double same_rad_s = kRounding_rad / kPeriod_s * std::sqrt(2.0 * (1.0 - a));
    const Wander w{.signal = &signal, .change = white(0.9 * same_rad_s)};
    const Whitening found = whitening_beside({&w, 1}, kLongest_s, kShortest_s);
    EXPECT_DOUBLE_EQ(found.time_constant_s, tau_s);
    // three standard errors of the wander's variance, 0.81 of 1.81, by N dt / tau independent samples
    const double sigma = kRounding_rad * std::sqrt((1.0 + 0.81) * 2.0 / (1.0 + a));
    const double independent = static_cast<double>(kSamples) * kPeriod_s / tau_s;
    EXPECT_NEAR(found.sigma, sigma, 3.0 * 0.5 * 0.81 / 1.81 * std::sqrt(2.0 / independent) * sigma);
  }
  const Wander strong{.signal = &signal, .change = white(10.0)};
  EXPECT_DOUBLE_EQ(whitening_beside({&strong, 1}, kLongest_s, kShortest_s).time_constant_s, kShortest_s);
}

}  // namespace
}  // namespace omnihil
