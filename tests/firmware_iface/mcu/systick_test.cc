#include "firmware_iface/mcu/machine/systick.h"

#include <gtest/gtest.h>

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kControl = 0, kLoad = 4, kValue = 8, kCountFlag = 1u << 16;

SysTick running(std::uint32_t load, std::uint32_t control, Cycles at) {
  SysTick tick;
  tick.write(kLoad, load, at);
  tick.write(kValue, 0, at);
  tick.write(kControl, control, at);
  return tick;
}

TEST(SysTickTest, CountsDownFromLoadToZeroInLoadPlusOneCycles) {
  SysTick tick = running(9, 7, 100);
  EXPECT_EQ(tick.read(kValue, 100), 0u);
  EXPECT_EQ(tick.read(kValue, 101), 9u);
  EXPECT_EQ(tick.read(kValue, 109), 1u);
  EXPECT_EQ(tick.next_event(), 110u);
  EXPECT_TRUE(tick.advance(110));
  EXPECT_EQ(tick.read(kValue, 110), 0u);
  EXPECT_EQ(tick.next_event(), 120u);
}

TEST(SysTickTest, TheCountFlagIsClearedByReadingIt) {
  SysTick tick = running(9, 5, 0);
  EXPECT_EQ(tick.read(kControl, 9) & kCountFlag, 0u);
  EXPECT_EQ(tick.read(kControl, 55), 5u | kCountFlag);
  EXPECT_EQ(tick.read(kControl, 56), 5u);
  EXPECT_EQ(tick.next_event(), kNever);  // no exception wanted
}

TEST(SysTickTest, ANewLoadHoldsFromTheNextReload) {
  SysTick tick = running(9, 7, 0);
  tick.read(kValue, 3);
  tick.write(kLoad, 99, 3);
  EXPECT_EQ(tick.next_event(), 10u);
  EXPECT_TRUE(tick.advance(10));
  EXPECT_EQ(tick.next_event(), 110u);
}

TEST(SysTickTest, StoppedItKeepsItsValue) {
  SysTick tick = running(99, 7, 0);
  tick.write(kControl, 0, 40);
  EXPECT_EQ(tick.read(kValue, 500), 60u);
  tick.write(kControl, 7, 1000);
  EXPECT_EQ(tick.read(kValue, 1010), 50u);
  EXPECT_EQ(tick.next_event(), 1060u);
}

TEST(SysTickTest, AnEighthOfTheClock) {
  const SysTick tick = running(9, 3, 0);
  EXPECT_EQ(tick.next_event(), 80u);
}

TEST(SysTickTest, AFlagThatWillBeSetIsSteadyUntilThen) {
  SysTick tick = running(9, 5, 0);  // zero at 10, 20, …
  EXPECT_EQ(tick.stable_until(kControl, 3), 10u);
  EXPECT_EQ(tick.stable_until(kControl, 9), 10u);
  EXPECT_EQ(tick.stable_until(kControl, 10), 0u);  // set, though nobody has looked
  tick.read(kControl, 12);                         // takes it away
  EXPECT_EQ(tick.stable_until(kControl, 12), 20u);
  tick.read(kLoad, 25);  // brings the counter on: the flag waits
  EXPECT_EQ(tick.stable_until(kControl, 26), 0u);
  EXPECT_EQ(tick.stable_until(kValue, 26), 0u);
  EXPECT_EQ(tick.stable_until(kLoad, 26), kNever);
}

TEST(SysTickTest, AFlagThatNothingSetsIsSteadyForEver) {
  EXPECT_EQ(running(0, 5, 0).stable_until(kControl, 100), kNever);
  SysTick stopped = running(9, 5, 0);
  stopped.write(kControl, 0, 3);
  EXPECT_EQ(stopped.stable_until(kControl, 100), kNever);
  EXPECT_EQ(stopped.stable_until(kValue, 100), kNever);
}

}  // namespace
}  // namespace omnihil::mcu
