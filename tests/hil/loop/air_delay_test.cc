// Latency, duplicates and order on the air against theory. Every run has its seed; bounds are exact binomial ones that
// a right program leaves once in 10^6 seeds on each side, or Kolmogorov's at one in 10^6.
#include "hil/loop/air_delay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/binomial_bounds.h"

namespace omnihil {
namespace {

constexpr int kMany = 100'000;
constexpr double kTail = 1e-6;

std::vector<double> latencies_s(const AirOptions& options, std::uint64_t seed) {
  AirDelay delay(options, seed);
  std::vector<double> late_s;
  for (int n = 0; n < kMany; ++n) {
    const AirFate fate = delay.fate(0, AirWay::kToRobot, 1'000'000LL * n);
    EXPECT_EQ(fate.copies, 1);
    late_s.push_back(1e-9 * static_cast<double>(fate.late_ns[0]));
  }
  return late_s;
}

// Kolmogorov 1933: P(sqrt(n) D > x) -> 2 exp(-2 x^2) for large x; 2.694 leaves one in 10^6.
void expect_distribution(std::vector<double> values, const std::function<double(double)>& below) {
  std::sort(values.begin(), values.end());
  double d = 0.0;
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double theory = below(values[i]);
    d = std::max({d, std::abs(theory - static_cast<double>(i) / n),
                  std::abs(theory - static_cast<double>(i + 1) / n)});
  }
  EXPECT_LT(d * std::sqrt(n), 2.694);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(AirDelay, WithoutOptionsAPacketArrivesOnceAndInTime) {
  AirDelay delay({}, 1);
  const AirFate fate = delay.fate(0, AirWay::kToHost, 5);
  EXPECT_EQ(fate.copies, 1);
  EXPECT_EQ(fate.late_ns[0], 0);
}

TEST(AirDelay, OneNumberIsAlwaysThatLatency) {
  for (const double s : latencies_s({.latency_least_s = 0.003, .latency_mean_s = 0.003}, 2))
    EXPECT_EQ(s, 0.003);
}

TEST(AirDelay, ExponentialAboveTheLeast) {
  const auto late_s = latencies_s({.latency_least_s = 0.002, .latency_mean_s = 0.005}, 3);
  EXPECT_NEAR(mean_of(late_s), 0.005, 5.0 * 0.003 / std::sqrt(kMany));  // its deviation is mean - least
  expect_distribution(late_s, [](double s) { return 1.0 - std::exp(-(s - 0.002) / 0.003); });
}

TEST(AirDelay, UniformAboveTheLeast) {
  const auto late_s = latencies_s(
      {.latency_least_s = 0.002, .latency_mean_s = 0.005, .latency_law = LatencyLaw::kUniform}, 4);
  EXPECT_NEAR(mean_of(late_s), 0.005, 5.0 * 0.006 / std::sqrt(12.0 * kMany));  // width / sqrt(12)
  expect_distribution(late_s, [](double s) { return (s - 0.002) / 0.006; });
}

TEST(AirDelay, LognormalAboveTheLeast) {
  constexpr double kSigma = 0.8, kAbove_s = 0.003;
  const auto late_s = latencies_s({.latency_least_s = 0.002,
                                   .latency_mean_s = 0.002 + kAbove_s,
                                   .latency_law = LatencyLaw::kLognormal,
                                   .latency_sigma = kSigma},
                                  5);
  const double deviation_s = kAbove_s * std::sqrt(std::exp(kSigma * kSigma) - 1.0);
  EXPECT_NEAR(mean_of(late_s), 0.005, 5.0 * deviation_s / std::sqrt(kMany));
  const double median_s = kAbove_s * std::exp(-0.5 * kSigma * kSigma);
  expect_distribution(late_s, [&](double s) {
    return 0.5 * std::erfc(-std::log((s - 0.002) / median_s) / (kSigma * std::sqrt(2.0)));
  });
}

// Pairs of packets that have nothing to do with each other: T apart, exponential latencies of mean m. The second overtakes
// the first when L1 > L2 + T: P = exp(-T/m) / 2.
TEST(AirDelay, PacketsOvertakeEachOtherAsOrderStatisticsSay) {
  constexpr std::int64_t kApart_ns = 2'000'000;
  constexpr double kMean_s = 0.003;
  AirDelay delay({.latency_mean_s = kMean_s}, 6);
  std::uint64_t overtaken = 0;
  for (int n = 0; n < kMany; ++n) {
    const std::int64_t first = delay.fate(0, AirWay::kToRobot, 0).late_ns[0];
    const std::int64_t second = kApart_ns + delay.fate(0, AirWay::kToRobot, kApart_ns).late_ns[0];
    overtaken += second < first ? 1 : 0;
  }
  const auto [low, high] = binomial_bounds(kMany, 0.5 * std::exp(-0.002 / kMean_s), kTail);
  EXPECT_GE(overtaken, low);
  EXPECT_LE(overtaken, high);
}

// Of a constant latency only what is held back is overtaken: held, and the next one not.
TEST(AirDelay, AHeldPacketIsOvertakenByTheNextOne) {
  constexpr double kHeld = 0.2;
  AirDelay delay({.held_share = kHeld, .held_s = 0.015}, 7);
  std::uint64_t overtaken = 0;
  for (int n = 0; n < kMany; ++n) {
    const std::int64_t first = delay.fate(0, AirWay::kToRobot, 0).late_ns[0];
    const std::int64_t second = 10'000'000 + delay.fate(0, AirWay::kToRobot, 10'000'000).late_ns[0];
    EXPECT_TRUE(first == 0 || first == 15'000'000) << first;
    overtaken += second < first ? 1 : 0;
  }
  const auto [low, high] = binomial_bounds(kMany, kHeld * (1.0 - kHeld), kTail);
  EXPECT_GE(overtaken, low);
  EXPECT_LE(overtaken, high);
  const auto [held_low, held_high] = binomial_bounds(2 * kMany, kHeld, kTail);
  EXPECT_GE(delay.counts().held, held_low);
  EXPECT_LE(delay.counts().held, held_high);
}

// The first of two copies with exponential latencies of mean m: exponential of mean m / 2.
TEST(AirDelay, AShareArrivesTwiceAndTheFirstCopyIsTheLesserOfTwo) {
  constexpr double kTwice = 0.05;
  AirDelay delay({.latency_mean_s = 0.004, .twice_share = kTwice}, 8);
  std::vector<double> first_s;
  for (int n = 0; n < kMany; ++n) {
    const AirFate fate = delay.fate(1, AirWay::kToHost, 0);
    if (fate.copies == 2)
      first_s.push_back(1e-9 * static_cast<double>(std::min(fate.late_ns[0], fate.late_ns[1])));
  }
  const auto [low, high] = binomial_bounds(kMany, kTwice, kTail);
  EXPECT_GE(first_s.size(), low);
  EXPECT_LE(first_s.size(), high);
  EXPECT_EQ(delay.counts().twice, first_s.size());
  expect_distribution(first_s, [](double s) { return 1.0 - std::exp(-s / 0.002); });
}

TEST(AirDelay, InOrderNoneOvertakesAndNoneComesBeforeItsTime) {
  const AirOptions loose{.latency_mean_s = 0.01, .twice_share = 0.1};
  AirOptions strict = loose;
  strict.in_order = true;
  AirDelay free(loose, 9), queue(strict, 9);
  std::int64_t before = 0;
  for (int n = 0; n < kMany; ++n) {
    const std::int64_t sent_ns = 2'000'000LL * n;
    const AirFate a = free.fate(0, AirWay::kToRobot, sent_ns), b = queue.fate(0, AirWay::kToRobot, sent_ns);
    ASSERT_EQ(a.copies, b.copies);  // the same draws
    for (std::size_t i = 0; i < static_cast<std::size_t>(b.copies); ++i) {
      EXPECT_EQ(sent_ns + b.late_ns[i], std::max(before, sent_ns + a.late_ns[i]));
      before = sent_ns + b.late_ns[i];
    }
  }
  EXPECT_GT(free.counts().overtaken, 0U);
  EXPECT_EQ(queue.counts().overtaken, 0U);
}

TEST(AirDelay, RobotsAndWaysKeepAnOrderOfTheirOwn) {
  AirDelay delay({.latency_least_s = 0.01, .latency_mean_s = 0.01, .in_order = true}, 10);
  EXPECT_EQ(delay.fate(0, AirWay::kToRobot, 50'000'000).late_ns[0], 10'000'000);
  EXPECT_EQ(delay.fate(1, AirWay::kToRobot, 0).late_ns[0], 10'000'000);
  EXPECT_EQ(delay.fate(0, AirWay::kToHost, 0).late_ns[0], 10'000'000);
  EXPECT_EQ(delay.fate(0, AirWay::kToRobot, 0).late_ns[0], 60'000'000);  // with the one before it
}

TEST(AirDelay, SaysWhatIsWrong) {
  EXPECT_TRUE(air_problems({.latency_mean_s = 0.01}).empty());
  EXPECT_EQ(air_problems({.latency_least_s = 0.02, .latency_mean_s = 0.01}).size(), 1U);
  EXPECT_EQ(air_problems({.latency_mean_s = 2.0}).size(), 1U);
  EXPECT_EQ(air_problems({.latency_mean_s = 0.01, .latency_law = LatencyLaw::kLognormal}).size(), 1U);
  EXPECT_EQ(air_problems({.latency_mean_s = 0.01, .latency_sigma = 0.5}).size(), 1U);
  EXPECT_EQ(air_problems({.held_share = 0.1}).size(), 1U);  // for no time
  EXPECT_EQ(air_problems({.bit_error_rate = 0.6}).size(), 1U);
}

}  // namespace
}  // namespace omnihil
