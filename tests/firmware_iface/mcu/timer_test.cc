// The counter, its outputs, captures, encoder and triggers against what the reference manual says in numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_iface/mcu/timer_bench.h"

namespace omnihil::mcu {
namespace {

TEST_F(TimerTest, PeriodIsExactlyPrescalerTimesReload) {
  set(kPsc, 6);
  set(kArr, 99);
  set(kEgr, 1);
  set(kSr, 0);
  set(kDier, 1);
  set(kCr1, 1);
  const Cycles period = (6 + 1) * (99 + 1);
  system.run_for(10 * period - 1);
  EXPECT_EQ(system.irq_rises[25], 1);  // one level, never acknowledged
  set(kSr, 0);
  const Cycles start = 0;
  for (int i = 10; i < 20; ++i) {
    system.run_until(start + period * static_cast<Cycles>(i) - 1);
    EXPECT_EQ(get(kSr) & 1, 0u) << i;
    system.run_for(1);
    EXPECT_EQ(get(kSr) & 1, 1u) << i;
    set(kSr, 0);
  }
}

TEST_F(TimerTest, CountFollowsTheClockWhetherLookedAtOrNot) {
  set(kArr, 999);
  set(kCr1, 1);
  system.run_for(123'456);
  EXPECT_EQ(get(kCnt), 123'456u % 1000);
  system.run_for(1);
  EXPECT_EQ(get(kCnt), 123'457u % 1000);
}

TEST_F(TimerTest, DownCountsFromReloadToZero) {
  set(kArr, 9);
  set(kCr1, 1u << 4);
  set(kEgr, 1);
  EXPECT_EQ(get(kCnt), 9u);
  set(kCr1, 1u << 4 | 1);
  for (std::uint32_t i = 1; i < 25; ++i) {
    system.run_for(1);
    EXPECT_EQ(get(kCnt), 9 - i % 10);
  }
}

TEST_F(TimerTest, CentreAlignedRunsUpAndDownInTwiceTheReload) {
  set(kArr, 10);
  set(kCr1, 3u << 5 | 1);
  for (std::uint32_t i = 1; i < 60; ++i) {
    system.run_for(1);
    const std::uint32_t phase = i % 20;
    EXPECT_EQ(get(kCnt), phase <= 10 ? phase : 20 - phase);
    EXPECT_EQ(get(kCr1) >> 4 & 1, phase >= 10 ? 1u : 0u) << i;
  }
}

TEST_F(TimerTest, UpdateGenerationSetsTheFlagAndRestarts) {
  set(kArr, 99);
  set(kCr1, 1);
  system.run_for(50);
  EXPECT_EQ(get(kSr) & 1, 0u);
  set(kEgr, 1);
  EXPECT_EQ(get(kSr) & 1, 1u);
  EXPECT_EQ(get(kCnt), 0u);
  set(kSr, 0);
  set(kCr1, 1 | 1u << 2);  // URS: updates by software set no flag
  set(kEgr, 1);
  EXPECT_EQ(get(kSr) & 1, 0u);
}

TEST_F(TimerTest, PreloadedReloadActsFromTheNextPeriod) {
  set(kArr, 99);
  set(kEgr, 1);
  set(kCr1, 1 | 1u << 7);
  system.run_for(30);
  set(kArr, 49);
  system.run_for(60);
  EXPECT_EQ(get(kCnt), 90u);
  system.run_for(10);
  EXPECT_EQ(get(kCnt), 0u);
  system.run_for(50);
  EXPECT_EQ(get(kCnt), 0u);
}

TEST_F(TimerTest, CounterAboveANewReloadRunsToTheTopOfItsBits) {
  set(kArr, 999);
  set(kCr1, 1);
  system.run_for(800);
  set(kArr, 499);  // without preload: at once
  set(kSr, 0);
  EXPECT_EQ(get(kCnt), 800u);
  system.run_for(100);
  EXPECT_EQ(get(kCnt), 900u);
  system.run_for(65536 - 900);
  EXPECT_EQ(get(kCnt), 0u);
  EXPECT_EQ(get(kSr) & 1, 0u);
  system.run_for(500);
  EXPECT_EQ(get(kSr) & 1, 1u);
}

TEST_F(TimerTest, RepetitionCounterDividesUpdates) {
  set(kArr, 9);
  set(kRcr, 3);
  set(kEgr, 1);
  set(kSr, 0);
  set(kCr1, 1);
  system.run_for(39);
  EXPECT_EQ(get(kSr) & 1, 0u);
  system.run_for(1);
  EXPECT_EQ(get(kSr) & 1, 1u);
}

TEST_F(TimerTest, RepetitionIsTheSameWhetherLookedAtOrSkipped) {
  set(kArr, 9);
  set(kRcr, 3);
  set(kEgr, 1);
  set(kCr1, 1);
  system.run_for(40 * 1000 + 35);
  set(kSr, 0);
  system.run_for(4);
  EXPECT_EQ(get(kSr) & 1, 0u);
  system.run_for(1);
  EXPECT_EQ(get(kSr) & 1, 1u);
}

TEST_F(TimerTest, OnePulseStopsAfterOnePeriod) {
  set(kArr, 99);
  set(kCr1, 1 | 1u << 3);
  system.run_for(99);
  EXPECT_EQ(get(kCr1) & 1, 1u);
  system.run_for(1);
  EXPECT_EQ(get(kCr1) & 1, 0u);
  EXPECT_EQ(get(kCnt), 0u);
  system.run_for(500);
  EXPECT_EQ(get(kCnt), 0u);
}

TEST_F(TimerTest, PwmDutyIsCompareOverPeriodFromNoneToAll) {
  set(kArr, 999);
  set(kEgr, 1);
  set(kCcmr1, 0x6060);  // PWM 1 on channels 1 and 2, no preload
  set(kCcer, 0x0011);
  set(kBdtr, 1u << 15);
  set(kCr1, 1);
  for (const std::uint32_t ccr : {0u, 1u, 250u, 999u, 1000u, 2000u}) {
    set(kCcr1, ccr);
    EXPECT_DOUBLE_EQ(timer.output(0).main.high_ratio, std::min(1.0, ccr / 1000.0));
    int high = 0;
    for (int i = 0; i < 1000; ++i) {
      system.run_for(1);
      get(kCnt);
      high += timer.reference(0) ? 1 : 0;
    }
    EXPECT_EQ(high, static_cast<int>(std::min(1000u, ccr)));
  }
  set(kCcer, 0x0033);  // inverted
  set(kCcr1, 250);
  EXPECT_DOUBLE_EQ(timer.output(0).main.high_ratio, 0.75);
}

TEST_F(TimerTest, CentreAlignedDutyIsCompareOverReload) {
  set(kArr, 500);
  set(kEgr, 1);
  set(kCcmr1, 0x0070);  // PWM 2
  set(kCcer, 1);
  set(kBdtr, 1u << 15);
  set(kCr1, 1 | 1u << 5);
  for (const std::uint32_t ccr : {0u, 125u, 499u, 500u}) {
    set(kCcr1, ccr);
    EXPECT_DOUBLE_EQ(timer.output(0).main.high_ratio, 1.0 - ccr / 500.0);
    int high = 0;
    for (int i = 0; i < 1000; ++i) {
      system.run_for(1);
      get(kCnt);
      high += timer.reference(0) ? 1 : 0;
    }
    EXPECT_EQ(high, static_cast<int>(1000 - 2 * ccr));
  }
}

TEST_F(TimerTest, PwmDrivesFromTheFirstPeriodOn) {
  set(kArr, 99);
  set(kEgr, 1);
  set(kCcmr1, 0x0060);
  set(kCcr1, 40);
  set(kCcer, 1);
  set(kBdtr, 1u << 15);
  set(kCr1, 1);
  EXPECT_TRUE(timer.reference(0));
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kPwm);
  EXPECT_DOUBLE_EQ(timer.output(0).main.high_ratio, 0.4);
}

TEST_F(TimerTest, PreloadedCompareActsAtTheUpdateAndIsHeardThen) {
  set(kArr, 99);
  set(kCcmr1, 0x0068);
  set(kCcr1, 20);
  set(kEgr, 1);
  set(kCcer, 1);
  set(kBdtr, 1u << 15);
  set(kCr1, 1);
  const Cycles start = system.now();
  system.run_for(50);
  set(kCcr1, 70);
  EXPECT_DOUBLE_EQ(timer.output(0).main.high_ratio, 0.2);
  system.run_for(200);
  EXPECT_DOUBLE_EQ(timer.output(0).main.high_ratio, 0.7);
  EXPECT_EQ(last_output_at, start + 100);
}

TEST_F(TimerTest, NoDriveWithoutMainOutputEnable) {
  set(kArr, 99);
  set(kCcmr1, 0x0060);
  set(kCcr1, 40);
  set(kCcer, 0x5);
  set(kCr1, 1);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kOff);
  set(kBdtr, 1u << 15 | 1u << 12 | 1u << 13);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kPwm);
  timer.break_input(true);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kOff);
  EXPECT_EQ(get(kSr) >> 7 & 1, 1u);
}

TEST_F(TimerTest, DeadTimeShortensBothSidesOfAPair) {
  set(kArr, 999);
  set(kEgr, 1);
  set(kCcmr1, 0x0060);
  set(kCcr1, 400);
  set(kCcer, 0x5);
  set(kBdtr, 1u << 15 | 20);
  set(kCr1, 1);
  const TimerOutput out = timer.output(0);
  EXPECT_DOUBLE_EQ(out.dead_time_s, 20 / 16e6);
  EXPECT_DOUBLE_EQ(out.main.high_ratio, 0.4 - 0.02);
  EXPECT_DOUBLE_EQ(out.complement.high_ratio, 0.6 - 0.02);
}

TEST_F(TimerTest, EncoderCountsAreThoseOfTheInstantOfTheReadAndWrapBothWays) {
  const auto shaft = [](std::int64_t at_ns) { return -5 + at_ns / 1000 * 2; };  // 2 counts per us
  timer.set_shaft(shaft);
  set(kArr, 99);
  set(kSmcr, 3);
  set(kCr1, 1);
  set(kCnt, 7);
  const std::int64_t start = shaft(system.to_ns(system.now()));
  for (int i = 0; i < 200; ++i) {
    system.run_for(37);
    const std::int64_t moved = shaft(system.to_ns(system.now())) - start;
    EXPECT_EQ(get(kCnt), static_cast<std::uint32_t>((7 + moved) % 100));
  }
  EXPECT_EQ(get(kCr1) >> 4 & 1, 0u);
  EXPECT_EQ(get(kSr) & 1, 1u);
  set(kCcer, 0x2);  // TI1 inverted: the other way round
  set(kCnt, 0);
  system.run_for(16);
  EXPECT_EQ(get(kCnt), 98u);
  EXPECT_EQ(get(kCr1) >> 4 & 1, 1u);
}

TEST_F(TimerTest, EncoderModesOneAndTwoCountTheEdgesOfOneInput) {
  std::int64_t at = 0;
  timer.set_shaft([&at](std::int64_t) { return at; });
  for (const std::uint32_t mode : {1u, 2u}) {
    at = 0;
    set(kCr1, 0);
    set(kArr, 0xFFFF);
    set(kSmcr, mode);
    set(kCr1, 1);
    set(kCnt, 0);
    at = 400;
    EXPECT_EQ(get(kCnt), 200u);
    at = -2;
    EXPECT_EQ(get(kCnt), 0xFFFFu);
  }
}

TEST_F(TimerTest, StoppedEncoderStandsStill) {
  std::int64_t at = 0;
  timer.set_shaft([&at](std::int64_t) { return at; });
  set(kSmcr, 3);
  set(kCr1, 1);
  at = 10;
  EXPECT_EQ(get(kCnt), 10u);
  set(kCr1, 0);
  at = 50;
  EXPECT_EQ(get(kCnt), 10u);
  set(kCr1, 1);
  at = 55;
  EXPECT_EQ(get(kCnt), 15u);
}

TEST_F(TimerTest, HallInterfaceCapturesTheTimeBetweenEdgesOfTheXor) {
  // TI1 = XOR of three inputs, both edges reset the counter (TI1F_ED), channel 1 captures TRC.
  set_other(kArr, 0xFFFFFFFF);
  set_other(kCr2, 1u << 7);
  set_other(kSmcr, 4u << 4 | 4);
  set_other(kCcmr1, 3);
  set_other(kCcer, 1);
  set_other(kDier, 1u << 1);
  set_other(kCr1, 1 | 1u << 2);
  other.set_input(0, true);
  set_other(kSr, 0);
  constexpr Cycles kGaps[] = {1000, 1234, 77};
  for (unsigned i = 0; i < 3; ++i) {
    system.run_for(kGaps[i]);
    other.set_input((i + 1) % 3, i != 2);
    EXPECT_EQ(system.read(kOther + kSr) >> 1 & 1, 1u);
    EXPECT_EQ(system.read(kOther + kCcr1), kGaps[i]);
    EXPECT_EQ(system.read(kOther + kSr) >> 1 & 1, 0u);  // reading CCR clears the flag
    EXPECT_EQ(system.read(kOther + kCnt), 0u);
  }
  EXPECT_EQ(system.irq_rises[28], 4);
}

TEST_F(TimerTest, MasterUpdateClocksASlaveCounter) {
  set(kArr, 99);
  set(kCr2, 2u << 4);
  set(kEgr, 1);
  set_other(kArr, 1000);
  set_other(kSmcr, 7);  // external clock: ITR0 = TIM1_TRGO
  set_other(kCr1, 1);
  set(kCr1, 1);
  system.run_for(100 * 42 + 50);
  EXPECT_EQ(system.read(kOther + kCnt), 42u);
}

TEST_F(TimerTest, CompareFlagComesWithTheMatchAndInterruptsThen) {
  set(kArr, 999);
  set(kEgr, 1);
  set(kCcr2, 600);
  set(kSr, 0);
  set(kDier, 1u << 2);
  set(kCr1, 1);
  system.run_for(599);
  EXPECT_EQ(system.irq_rises[27], 0);
  system.run_for(1);
  EXPECT_EQ(system.irq_rises[27], 1);
}

TEST_F(TimerTest, NothingIsScheduledThatNobodyWaitsFor) {
  set(kArr, 9);
  set(kCr1, 1);
  system.run_for(10'000'000);
  EXPECT_EQ(system.events, 0u);
}

// An ADC that is set up after its timer has been started: the timer has nothing else to do.
TEST_F(TimerTest, WhoBeginsToListenToARunningTimerHearsItsNextEdges) {
  struct Ear final : TriggerSink {
    void triggered(int, bool rising) override { (rising ? rises : falls)++; }
    int rises = 0, falls = 0;
  } ear;
  set(kArr, 999);
  set(kCcr1, 250);
  set(kCcmr1, 6u << 4);
  set(kCr1, 1);
  system.run_for(1500);
  const int source = context.triggers.source("TIM1_CC1");
  context.triggers.listen(source, ear, true);
  system.run_for(10'000);
  EXPECT_EQ(ear.rises, 10);
  EXPECT_EQ(ear.falls, 10);
  context.triggers.listen(source, ear, false);
  system.run_for(10'000);
  EXPECT_EQ(ear.rises, 10);
}

TEST_F(TimerTest, ApbPrescalerChangeKeepsTheCount) {
  set(kArr, 0xFFFF);
  set(kCr1, 1);
  system.run_for(1000);
  ClockState state = context.clocks.state();
  state.timers[2] = {1, 4};
  context.clocks.set(state);
  EXPECT_EQ(get(kCnt), 1000u);
  system.run_for(400);
  EXPECT_EQ(get(kCnt), 1100u);
}

TEST_F(TimerTest, CommutationEventMovesPreloadedEnablesAtOnce) {
  set(kArr, 99);
  set(kEgr, 1);
  set(kBdtr, 1u << 15);
  set(kCr2, 1);  // CCPC
  set(kCcmr1, 0x6060);
  set(kCcr1, 30);
  set(kCcer, 1);
  set(kCr1, 1);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kOff);
  set(kEgr, 1u << 5);
  EXPECT_EQ(timer.output(0).main.drive, TimerPin::Drive::kPwm);
  EXPECT_EQ(get(kSr) >> 5 & 1, 1u);
}

}  // namespace
}  // namespace omnihil::mcu
