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

}  // namespace
}  // namespace omnihil::mcu
