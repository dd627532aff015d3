// Offset and drift of another clock from messages that are late by chance.
#include "hil/loop/clock_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace omnihil {
namespace {

// Theirs runs slower by `drift`; ours = theirs + offset + drift (theirs - start). Delays: `least` and an exponential.
ClockLine seen(double offset_s, double drift, double least_s, double mean_s, double duration_s,
               int seed = 1) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::exponential_distribution<double> more(1.0 / mean_s);
  ClockLine line;
  const double start_s = 1.7e9;  // Unix time: the digits must not be lost
  for (int k = 0; k < static_cast<int>(60.0 * duration_s); ++k) {
    const double sent = start_s + k / 60.0;
    line.add(sent, sent + offset_s + drift * (sent - start_s) + least_s + more(random));
  }
  return line;
}

TEST(ClockLine, FindsOffsetAndDriftUnderRandomDelays) {
  for (int seed = 1; seed <= 20; ++seed) {
    const double drift = 1e-5 * (seed - 10);
    const ClockFit fit = seen(-123.456, drift, 0.002, 0.005, 60.0, seed).fit();
    // Of 3600 exponential delays the edge's ends are late by some mean / 1000 each.
    EXPECT_NEAR(fit.drift_ratio, drift, 4e-6) << seed;
    EXPECT_NEAR(fit.ours(1.7e9 + 30.0), 1.7e9 + 30.0 - 123.456 + drift * 30.0 + 0.002, 2e-4) << seed;
    EXPECT_NEAR(fit.delay_p50_s, 0.005 * std::log(2.0), 3e-4) << seed;  // the median of an exponential
  }
}

TEST(ClockLine, TheLineLiesBelowEveryMessage) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> late(0.0, 0.02);
  ClockLine line;
  std::vector<std::pair<double, double>> all;
  for (int k = 0; k < 2000; ++k) {
    all.emplace_back(k / 60.0, k / 60.0 + late(random));
    line.add(all.back().first, all.back().second);
  }
  const ClockFit fit = line.fit();
  for (const auto& [sent, arrived] : all) EXPECT_GE(arrived, fit.ours(sent) - 1e-12);
}

TEST(ClockLine, AShortRecordHasNoDrift) {
  const ClockFit fit = seen(5.0, 0.0, 0.0, 0.004, 2.0).fit();
  EXPECT_EQ(fit.drift_ratio, 0.0);
  EXPECT_NEAR(fit.offset_s, 5.0, 2e-4);
}

TEST(ClockLine, AClockThatIsSetAnewBeginsANewLine) {
  ClockLine line;
  for (int k = 0; k < 600; ++k) line.add(k / 60.0, k / 60.0 + 1.0);
  for (int k = 600; k < 1800; ++k) line.add(k / 60.0 + 3600.0, k / 60.0);
  const ClockFit fit = line.fit();
  EXPECT_EQ(fit.set_anew, 1u);
  EXPECT_NEAR(fit.offset_s, -3600.0, 1e-9);
}

TEST(ClockLine, NothingSeenIsNotKnown) { EXPECT_FALSE(ClockLine{}.fit().known()); }

}  // namespace
}  // namespace omnihil
