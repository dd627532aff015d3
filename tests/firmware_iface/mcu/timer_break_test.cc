// The break input of an advanced timer: what it switches off, when, and what comes back.
#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/timer_bench.h"

namespace omnihil::mcu {
namespace {

struct TimerBreakTest : TimerTest {};

// The break input works without the clock: at the instant of its edge, in the middle of a period as well.
TEST_F(TimerBreakTest, ABreakSwitchesTheOutputsOffAtItsInstant) {
  set(kArr, 999);
  set(kCcmr1, 0x0060);
  set(kCcr1, 400);
  set(kCcer, 0x5);
  set(kDier, 1u << 7);
  set(kBdtr, 1u << 15 | 1u << 12);  // active low
  set(kCr1, 1);
  timer.break_input(true);
  system.run_for(537);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kPwm);
  timer.break_input(false);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kOff);
  EXPECT_EQ(timer.output(0).complement.drive, TimerPin::Drive::kOff);
  EXPECT_EQ(last_output_at, system.now()) << "no cycle later";
  EXPECT_EQ(get(kBdtr) >> 15 & 1, 0u);
  set(kSr, 0);
  EXPECT_EQ(get(kSr) >> 7 & 1, 1u) << "the flag stays while the input is active";
  set(kBdtr, 1u << 15 | 1u << 12);
  EXPECT_EQ(get(kBdtr) >> 15 & 1, 0u) << "and so does MOE";
  timer.break_input(true);
  set(kSr, 0);
  EXPECT_EQ(get(kSr) >> 7 & 1, 0u);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kOff) << "until software switches on again";
  set(kBdtr, 1u << 15 | 1u << 12);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kPwm);
}

TEST_F(TimerBreakTest, OutputsComeBackByThemselvesWithTheNextUpdateWhereAoeSaysSo) {
  set(kArr, 999);
  set(kCcmr1, 0x0060);
  set(kCcr1, 400);
  set(kCcer, 0x1);
  set(kBdtr, 1u << 15 | 1u << 14 | 1u << 13 | 1u << 12);
  set(kCr1, 1);
  system.run_for(300);
  timer.break_input(true);
  system.run_for(1000);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kOff) << "still active at the update";
  timer.break_input(false);
  system.run_for(699);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kOff);
  system.run_for(1);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kPwm);
}

TEST_F(TimerBreakTest, ABreakThatIsThereBeforeItIsEnabledActsThen) {
  timer.break_input(true);
  set(kBdtr, 1u << 15 | 1u << 13);
  EXPECT_EQ(get(kBdtr) >> 15 & 1, 1u) << "not enabled";
  set(kBdtr, 1u << 15 | 1u << 13 | 1u << 12);
  EXPECT_EQ(get(kBdtr) >> 15 & 1, 0u);
}

}  // namespace
}  // namespace omnihil::mcu
