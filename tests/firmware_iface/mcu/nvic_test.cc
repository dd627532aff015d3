#include "firmware_iface/mcu/machine/nvic.h"

#include <gtest/gtest.h>

namespace omnihil::mcu {
namespace {

constexpr int kA = kFirstIrq, kB = kFirstIrq + 1, kC = kFirstIrq + 2;

Nvic with_all_enabled(unsigned prigroup) {
  Nvic nvic(kCortexM4F);
  nvic.set_group(prigroup);
  for (const int e : {kA, kB, kC}) nvic.set_enabled(e, true);
  return nvic;
}

TEST(NvicTest, TheLowerNumberOfEqualPriorityGoesFirst) {
  Nvic nvic = with_all_enabled(0);
  nvic.set_pending(kC, 0);
  nvic.set_pending(kB, 0);
  EXPECT_EQ(nvic.best(Nvic::kLowest), kB);
}

TEST(NvicTest, SubpriorityOrdersButDoesNotPreempt) {
  // PRIGROUP 5: bits 7 and 6 preempt, the rest orders.
  Nvic nvic = with_all_enabled(5);
  nvic.set_priority(kA, 0x70);
  nvic.set_priority(kB, 0x50);
  nvic.set_pending(kA, 0);
  nvic.set_pending(kB, 0);
  EXPECT_EQ(nvic.best(Nvic::kLowest), kB);
  nvic.activate(kA);
  EXPECT_EQ(nvic.best(nvic.execution_priority(false, false, 0)), 0);
  nvic.set_priority(kC, 0x30);
  nvic.set_pending(kC, 0);
  EXPECT_EQ(nvic.best(nvic.execution_priority(false, false, 0)), kC);
}

TEST(NvicTest, MasksAreComparedInGroups) {
  Nvic nvic = with_all_enabled(5);
  nvic.set_priority(kA, 0x60);
  nvic.set_pending(kA, 0);
  EXPECT_EQ(nvic.best(nvic.execution_priority(false, false, 0x70)), 0);  // the same group
  EXPECT_EQ(nvic.best(nvic.execution_priority(false, false, 0x80)), kA);
  EXPECT_EQ(nvic.best(nvic.execution_priority(true, false, 0)), 0);
  nvic.set_pending(kHardFault, 0);
  EXPECT_EQ(nvic.best(nvic.execution_priority(true, false, 0)), kHardFault);
  EXPECT_EQ(nvic.best(nvic.execution_priority(false, true, 0)), 0);
  nvic.set_pending(kNmi, 0);
  EXPECT_EQ(nvic.best(nvic.execution_priority(false, true, 0)), kNmi);
}

TEST(NvicTest, ADisabledInterruptStaysPending) {
  Nvic nvic = with_all_enabled(0);
  nvic.set_enabled(kA, false);
  nvic.set_line(0, true, 5);
  EXPECT_TRUE(nvic.pending(kA));
  EXPECT_EQ(nvic.best(Nvic::kLowest), 0);
  nvic.set_enabled(kA, true);
  EXPECT_EQ(nvic.best(Nvic::kLowest), kA);
  EXPECT_EQ(nvic.pended_at(kA), 5u);
}

TEST(NvicTest, ALinePendsByItsEdgeAndWhenStillHighAfterTheHandler) {
  Nvic nvic = with_all_enabled(0);
  nvic.set_line(0, true, 0);
  nvic.activate(kA);
  nvic.set_line(0, true, 1);
  EXPECT_FALSE(nvic.pending(kA));
  nvic.deactivate(kA, 2);
  EXPECT_TRUE(nvic.pending(kA));
  nvic.activate(kA);
  nvic.set_line(0, false, 3);
  nvic.deactivate(kA, 4);
  EXPECT_FALSE(nvic.pending(kA));
}

TEST(NvicTest, OnlyThePriorityBitsOfTheVariantExist) {
  Nvic m4(kCortexM4F), m0(kCortexM0);
  m4.set_priority(kA, 0xFF);
  m0.set_priority(kA, 0xFF);
  EXPECT_EQ(m4.priority(kA), 0xF0);
  EXPECT_EQ(m0.priority(kA), 0xC0);
}

}  // namespace
}  // namespace omnihil::mcu
