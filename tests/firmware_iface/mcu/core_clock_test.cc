#include "firmware_iface/mcu/machine/core_clock.h"

#include <gtest/gtest.h>

namespace omnihil::mcu {
namespace {

TEST(CoreClockTest, CountsBothWaysOverAChangeOfRate) {
  CoreClock clock(16'000'000);
  EXPECT_EQ(clock.to_ns(16), 1000);
  clock.change(1600, 168'000'000);  // at 100 us
  EXPECT_EQ(clock.to_ns(1600), 100'000);
  EXPECT_EQ(clock.to_ns(1600 + 168), 101'000);
  EXPECT_EQ(clock.to_ns(16), 1000);  // what was before stays
  EXPECT_EQ(clock.from_ns(1000), 16u);
  EXPECT_EQ(clock.from_ns(101'000), 1768u);
}

TEST(CoreClockTest, FromNsIsTheFirstCycleNotBefore) {
  const CoreClock clock(72'000'000);
  for (std::int64_t ns = 1; ns < 2000; ns += 7) {
    const Cycles at = clock.from_ns(ns);
    // at / 72 MHz >= ns and (at - 1) / 72 MHz < ns, in integers.
    EXPECT_GE(at * 1000u, static_cast<Cycles>(ns) * 72u) << ns;
    EXPECT_LT((at - 1) * 1000u, static_cast<Cycles>(ns) * 72u) << ns;
  }
}

// time(c) >= t and time(c - 1) < t; both ends in whole nanoseconds, rounded down by to_ns().
TEST(CoreClockTest, FromNsIsTheFirstCycleNotBeforeAfterAChangeBetweenTwoNanoseconds) {
  CoreClock clock(72'000'000);
  clock.change(7, 168'000'000);   // at 97.2 ns
  clock.change(18, 275'000'000);  // at 162.7 ns
  for (std::int64_t ns = 163; ns < 5'000'000'000; ns += 1 + ns / 3) {
    const Cycles at = clock.from_ns(ns);
    EXPECT_GE(clock.to_ns(at), ns);
    EXPECT_LT(clock.to_ns(at - 1), ns);
  }
}

TEST(CoreClockTest, ADayDoesNotDrift) {
  const CoreClock clock(168'000'000);
  constexpr std::uint64_t kDay_s = 86'400;
  EXPECT_EQ(clock.to_ns(168'000'000 * kDay_s), static_cast<std::int64_t>(kDay_s * 1'000'000'000));
}

}  // namespace
}  // namespace omnihil::mcu
