// The clock trees of the families, as their start-up code sets them.
#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

TEST(ClockTree, F4RunsAt168MHzFromAn8MHzCrystal) {
  ChipBench b("stm32f407");
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 16e6);
  b.set("RCC", 0x00, 1 | 1u << 16);
  EXPECT_EQ(b.get("RCC", 0x00) >> 17 & 1, 1u);  // HSERDY
  b.set("RCC", 0x04, 8 | 336u << 6 | 0u << 16 | 1u << 22 | 7u << 24);
  b.set("RCC", 0x00, 1 | 1u << 16 | 1u << 24);
  EXPECT_EQ(b.get("RCC", 0x00) >> 25 & 1, 1u);  // PLLRDY
  b.set("RCC", 0x08, 2 | 5u << 10 | 4u << 13);  // PLL; APB1 / 4, APB2 / 2
  EXPECT_EQ(b.get("RCC", 0x08) >> 2 & 3, 2u);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 168e6);
  const ClockTree& clocks = b.chip.context().clocks;
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb1), 42e6);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb2), 84e6);
  EXPECT_EQ(clocks.timers(Bus::kApb1), (ClockRatio{1, 2}));  // 84 MHz
  EXPECT_EQ(clocks.timers(Bus::kApb2), (ClockRatio{1, 1}));  // 168 MHz
}

TEST(ClockTree, AClockThatIsOffIsNotSelectedAndIsReported) {
  ChipBench b("stm32f405");
  b.set("RCC", 0x08, 1);
  EXPECT_EQ(b.get("RCC", 0x08) >> 2 & 3, 0u);
  EXPECT_EQ(b.system.unmodelled.size(), 1u);
}

TEST(ClockTree, F3RunsAt72MHzAndFeedsTimerOneFromTwiceThePll) {
  ChipBench b("stm32f303");
  b.set("RCC", 0x00, 1 | 1u << 16 | 1u << 24);
  b.set("RCC", 0x04, 2 | 4u << 8 | 1u << 16 | 7u << 18);  // HSE x 9, APB1 / 2
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 72e6);
  b.set("TIM1", 0x2C, 999);
  b.set("TIM1", 0x00, 1);
  b.system.run_for(100);
  EXPECT_EQ(b.get("TIM1", 0x24), 100u);
  b.set("TIM1", 0x24, 0);
  b.set("RCC", 0x30, 1u << 8);  // TIM1SW
  b.system.run_for(100);
  EXPECT_EQ(b.get("TIM1", 0x24), 200u);
}

TEST(ClockTree, F0RunsAt48MHzFromItsOwnOscillator) {
  ChipBench b("stm32f031");
  b.set("RCC", 0x04, 10u << 18);
  b.set("RCC", 0x00, 1 | 1u << 24);
  b.set("RCC", 0x04, 10u << 18 | 2);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 48e6);
}

// LSERDY follows LSEON; the bit behind BDRST, which resets the domain, says nothing.
TEST(ClockTree, OfTheBackupDomainTheOscillatorAloneIsReady) {
  ChipBench b("stm32f303");
  b.set("RCC", 0x20, 1);
  EXPECT_EQ(b.get("RCC", 0x20) & 3u, 3u);
  b.set("RCC", 0x20, 1u << 16);
  EXPECT_EQ(b.get("RCC", 0x20) >> 16, 1u);
}

TEST(ClockTree, G4RunsAt170MHz) {
  ChipBench b("stm32g474");
  b.set("RCC", 0x0C, 2 | 3u << 4 | 85u << 8 | 1u << 24);  // HSI16 / 4 * 85 / 2
  b.set("RCC", 0x00, 1u << 8 | 1u << 24);
  b.set("RCC", 0x08, 3);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 170e6);
}

TEST(ClockTree, ResetFlagsNameTheCauseUntilCleared) {
  ChipBench b("stm32f405");
  EXPECT_EQ(b.get("RCC", 0x74) >> 27 & 1, 1u);
  b.system.cause = "IWDG";
  b.chip.reset();
  EXPECT_EQ(b.get("RCC", 0x74) >> 29 & 1, 1u);
  EXPECT_EQ(b.get("RCC", 0x74) >> 27 & 1, 0u);
  b.set("RCC", 0x74, 1u << 24);
  EXPECT_EQ(b.get("RCC", 0x74) >> 24, 0u);
}

TEST(Power, VoltageScalingIsReady) {
  ChipBench b("stm32f407");
  EXPECT_EQ(b.get("PWR", 0x04) >> 14 & 1, 1u);
}

TEST(Identity, UniqueIdAndFlashSizeAreReadable) {
  ChipBench b("stm32f407");
  // the made-up lot and wafer that every chip has
  EXPECT_EQ(b.system.read(0x1FFF7A10), 0x0033001Fu);
  EXPECT_EQ(b.system.read(0x1FFF7A14), 0x30345105u);
  EXPECT_EQ(b.system.read(0x1FFF7A18), 0x36373734u);
  EXPECT_EQ(b.system.read(0x1FFF7A20) >> 16, 1024u);
}

TEST(UsbStub, CoreResetLoopEnds) {
  ChipBench b("stm32f407");
  b.set("OTG_FS", 0x10, 1);
  EXPECT_EQ(b.get("OTG_FS", 0x10), 0x80000000u);
  EXPECT_EQ(b.system.unmodelled.size(), 1u);
}

TEST(FlashController, UnlocksErasesAndProgramsOnlyByItsKeys) {
  ChipBench b("stm32f303");
  Flash& flash = *b.chip.flash();
  constexpr std::uint32_t kPage = 0x0801F000;
  flash.flash_write(kPage, 2, 0x1234);
  EXPECT_EQ(b.system.memory[kPage], 0u);
  b.unlock_flash(0x04);
  EXPECT_EQ(b.get("FLASH", 0x10) >> 7 & 1, 0u);
  b.set("FLASH", 0x10, 2);
  b.set("FLASH", 0x14, kPage + 6);
  b.set("FLASH", 0x10, 2 | 1u << 6);
  EXPECT_EQ(b.system.memory[kPage], 0xFFu);
  EXPECT_EQ(b.system.memory[kPage + 2047], 0xFFu);
  b.set("FLASH", 0x10, 1);
  flash.flash_write(kPage, 2, 0x1234);
  EXPECT_EQ(b.system.memory[kPage], 0x34u);
  EXPECT_EQ(b.system.memory[kPage + 1], 0x12u);
}

TEST(Watchdog, UnfedItResetsAfterItsTimeAndNotBefore) {
  ChipBench b("stm32f405");
  b.set("IWDG", 0x00, 0x5555);
  b.set("IWDG", 0x04, 0);
  b.set("IWDG", 0x08, 99);
  b.set("IWDG", 0x00, 0xCCCC);
  const std::int64_t time_ns = 1'000'000'000LL * 4 * 100 / 32000;
  b.system.run_for_ns(time_ns - 1000);
  b.set("IWDG", 0x00, 0xAAAA);
  b.system.run_for_ns(time_ns - 1000);
  EXPECT_TRUE(b.system.resets.empty());
  b.system.run_for_ns(2000);
  ASSERT_EQ(b.system.resets.size(), 1u);
  EXPECT_EQ(b.system.resets[0], "IWDG");
}

// A firmware that is about to write flash makes it slow, and feeds it while SR says that this is on its way.
TEST(Watchdog, APrescalerWrittenWhileItRunsCountsWhatIsLeftOnAtTheNewRate) {
  ChipBench b("stm32f405");
  b.set("IWDG", 0x00, 0x5555);
  b.set("IWDG", 0x04, 0);  // over 4
  b.set("IWDG", 0x08, 99);
  b.set("IWDG", 0x00, 0xCCCC);
  const std::int64_t count_ns = 1'000'000'000LL * 4 / 32000;
  b.system.run_for_ns(40 * count_ns);
  EXPECT_EQ(b.get("IWDG", 0x0C), 0u);
  b.set("IWDG", 0x00, 0x5555);
  b.set("IWDG", 0x04, 4);  // over 64
  EXPECT_EQ(b.get("IWDG", 0x0C), 1u);
  b.set("IWDG", 0x08, 999);
  EXPECT_EQ(b.get("IWDG", 0x0C), 3u);
  b.system.run_for_ns(5 * 1'000'000'000LL / 32000 + 1000);
  EXPECT_EQ(b.get("IWDG", 0x0C), 0u);
  b.system.run_for_ns((60 * 16 - 2) * count_ns - 5 * 1'000'000'000LL / 32000);
  EXPECT_TRUE(b.system.resets.empty());
  b.system.run_for_ns(4 * count_ns);
  EXPECT_EQ(b.system.resets.size(), 1u);
}

TEST(WindowWatchdog, ResetsWhenFedTooEarly) {
  ChipBench b("stm32f405");
  b.set("WWDG", 0x04, 0x50);
  b.set("WWDG", 0x00, 0x80 | 0x7F);
  b.system.run_for(4096 * 10);
  b.set("WWDG", 0x00, 0x7F);
  ASSERT_EQ(b.system.resets.size(), 1u);
  EXPECT_EQ(b.system.resets[0], "WWDG");
}

TEST(PinInterrupts, AnEdgeOnTheSelectedPortRaisesItsLineUntilItIsCleared) {
  ChipBench b("stm32f407");
  b.set("SYSCFG", 0x14, 1u << 4);  // line 13: port B
  b.set("EXTI", 0x00, 1u << 13);
  b.set("EXTI", 0x0C, 1u << 13);  // falling
  b.chip.port('B')->drive(13, true);
  b.chip.port('A')->drive(13, true);
  b.chip.port('A')->drive(13, false);
  EXPECT_FALSE(b.system.irq_high[40]);
  b.chip.port('B')->drive(13, false);
  EXPECT_TRUE(b.system.irq_high[40]);
  b.set("EXTI", 0x14, 1u << 13);
  EXPECT_FALSE(b.system.irq_high[40]);
}

TEST(Pins, SetWinsOverResetAndOutputsAreHeard) {
  ChipBench b("stm32f407");
  int heard = 0;
  bool level = false;
  b.chip.port('E')->on_output(3, [&](bool high) {
    ++heard;
    level = high;
  });
  b.set("GPIOE", 0x18, 1u << 3);  // still an input: nobody hears
  EXPECT_EQ(heard, 0);
  b.set("GPIOE", 0x00, 1u << 6);
  EXPECT_EQ(heard, 1);
  EXPECT_TRUE(level);
  b.set("GPIOE", 0x18, 1u << 19);
  EXPECT_FALSE(level);
  b.set("GPIOE", 0x18, 1u << 19 | 1u << 3);
  EXPECT_TRUE(level);
  EXPECT_EQ(b.get("GPIOE", 0x10) >> 3 & 1, 1u);
}

}  // namespace
}  // namespace omnihil::mcu
