#include "hil/loop/clock.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(LatenessHistogramTest, QuantilesAreExactBelow64ns) {
  LatenessHistogram late;
  for (int ns = 1; ns <= 50; ++ns) late.add(ns);
  EXPECT_EQ(late.quantile_ns(0.5), 25);
  EXPECT_EQ(late.quantile_ns(1.0), 50);
  EXPECT_EQ(late.max_ns(), 50);
}

TEST(LatenessHistogramTest, QuantilesAreNeverTooSmallAndAtMostOne32ndTooLarge) {
  LatenessHistogram late;
  std::vector<std::int64_t> values;
  std::uint64_t state = 1;
  for (int i = 0; i < 10'000; ++i) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    values.push_back(static_cast<std::int64_t>((state >> 33) % 50'000'000) + 100);
    late.add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double q : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto exact = values[static_cast<std::size_t>(q * 10'000) - 1];
    EXPECT_GE(late.quantile_ns(q), exact) << q;
    EXPECT_LE(late.quantile_ns(q), exact + exact / 32 + 1) << q;
  }
  EXPECT_EQ(late.max_ns(), values.back());
}

TEST(LatenessHistogramTest, HoldsTheLargestAndTheSmallestDuration) {
  LatenessHistogram late;
  late.add(-5);
  late.add(INT64_MAX);
  EXPECT_EQ(late.quantile_ns(0.5), 0);
  EXPECT_EQ(late.quantile_ns(1.0), INT64_MAX);
  EXPECT_EQ(LatenessHistogram().quantile_ns(0.5), 0);
}

TEST(DeadlineKeeperTest, DeadlinesStayOnTheAbsoluteGridHoweverLateStepsAre) {
  DeadlineKeeper keeper({kMs, 20 * kMs}, 1000);
  for (int k = 0; k < 1000; ++k) {
    ASSERT_EQ(keeper.deadline_ns(), 1000 + k * kMs);
    keeper.begin_step(keeper.deadline_ns() + (k * 7919) % (5 * kMs));
  }
  EXPECT_EQ(keeper.report().slipped_ns, 0);
  EXPECT_EQ(keeper.report().lateness.count(), 1000u);
}

TEST(DeadlineKeeperTest, AStallWithinTheBacklogIsCaughtUp) {
  DeadlineKeeper keeper({kMs, 20 * kMs}, 0);
  std::int64_t now = 15 * kMs;  // steps 0..15 are due at once
  int run_without_waiting = 0;
  while (keeper.deadline_ns() <= now) {
    keeper.begin_step(now);
    ++run_without_waiting;
  }
  EXPECT_EQ(run_without_waiting, 16);
  EXPECT_EQ(keeper.report().slipped_ns, 0);
  EXPECT_EQ(keeper.report().late_steps, 15u);
}

TEST(DeadlineKeeperTest, AStallBeyondTheBacklogSlipsByExactlyTheExcessAndIsCountedOnce) {
  DeadlineKeeper keeper({kMs, 20 * kMs}, 0);
  const std::int64_t now = 32'300'000;  // 12.3 ms beyond the backlog
  int run_without_waiting = 0;
  while (keeper.deadline_ns() <= now) {
    keeper.begin_step(now);
    ++run_without_waiting;
  }
  EXPECT_EQ(keeper.report().slipped_ns, 12'300'000);
  EXPECT_EQ(keeper.report().slips, 1u);
  EXPECT_EQ(run_without_waiting, 21);
  // simulated time = steps * 1 ms = wall time - slip, to the step that is due next
  EXPECT_EQ(keeper.deadline_ns(), 21 * kMs + keeper.report().slipped_ns);
}

TEST(DeadlineKeeperTest, TimeThatADebuggerHeldTheLoopIsForgivenWhole) {
  DeadlineKeeper keeper({kMs, 20 * kMs}, 0);
  keeper.begin_step(0);  // and the step takes 5 s, of which GDB had 4.999
  keeper.forgive(4'999 * kMs);
  keeper.begin_step(5'000 * kMs);
  EXPECT_EQ(keeper.report().slipped_ns, 0);
  EXPECT_EQ(keeper.report().late_steps, 0u);
  EXPECT_EQ(keeper.deadline_ns(), 5'001 * kMs);
}

TEST(RealClockTest, NeverStartsAStepBeforeItsDeadline) {
  const std::int64_t start = monotonic_now_ns();
  RealClock clock({.step_ns = kMs, .backlog_ns = 20 * kMs});
  for (int k = 0; k <= 20; ++k) ASSERT_TRUE(clock.wait());
  EXPECT_GE(monotonic_now_ns() - start, 20 * kMs);  // a lower bound, whatever else runs here
  EXPECT_EQ(clock.report().lateness.count(), 21u);
  EXPECT_TRUE(clock.report().real_time);
}

TEST(RealClockTest, StepZeroIsDueWhenItWasTold) {
  const std::int64_t start = monotonic_now_ns() + 5 * kMs;
  RealClock clock({.step_ns = kMs, .start_ns = start});
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(clock.wait());
    EXPECT_GE(monotonic_now_ns(), start + k * kMs);
  }
}

// Voluntary context switches of this thread since it began.
long times_slept() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

long times_slept_in(RealClock& clock, int steps) {
  const long before = times_slept();
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(clock.wait());
  return times_slept() - before;
}

TEST(RealClockTest, ThatSpinsThroughTheWholeStepNeverSleepsAndIsNeverEarly) {
  const std::int64_t start = monotonic_now_ns() + kMs / 2;
  RealClock awake({.step_ns = kMs, .start_ns = start, .spin_ns = kMs});
  EXPECT_EQ(times_slept_in(awake, 20), 0);
  EXPECT_GE(monotonic_now_ns(), start + 19 * kMs);
  // The same without: steps of 50 ms, so that no load of the machine leaves none to sleep for.
  RealClock asleep({.step_ns = 50 * kMs, .start_ns = monotonic_now_ns() + 50 * kMs});
  EXPECT_GE(times_slept_in(asleep, 3), 1);
}

TEST(RealClockTest, ThatSpinsForAPartSleepsForTheRest) {
  RealClock clock({.step_ns = 50 * kMs, .start_ns = monotonic_now_ns() + 50 * kMs, .spin_ns = kMs});
  EXPECT_GE(times_slept_in(clock, 3), 1);
}

TEST(FreeClockTest, NeverWaitsAndReportsNoLateness) {
  FreeClock clock;
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(clock.wait());
  EXPECT_EQ(clock.report().lateness.count(), 0u);
  EXPECT_FALSE(clock.report().real_time);
}

}  // namespace
}  // namespace omnihil
