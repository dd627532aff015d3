// F103: what its densities have, its ports, clocks, converters, request lines (RM0008).
#include <gtest/gtest.h>

#include <string>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

TEST(F1Parts, MediumDensityLacksWhatHighDensityHasMore) {
  const ChipBench medium("stm32f103cb"), high("stm32f103ze");
  for (const char* block : {"GPIOF", "TIM5", "TIM6", "TIM8", "ADC3", "DMA2", "UART4", "SPI3", "SDIO"}) {
    EXPECT_EQ(medium.base(block), 0u) << block;
    EXPECT_NE(high.base(block), 0u) << block;
  }
  for (const Chip::Mapped& block : medium.chip.blocks())
    EXPECT_EQ(high.base(block.peripheral->name()), block.base) << block.peripheral->name();
}

TEST(F1Parts, RunsAt72MHzAndItsTimersToo) {
  ChipBench b("stm32f103");
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 8e6);
  b.set("RCC", 0x00, 1 | 1u << 16);
  EXPECT_EQ(b.get("RCC", 0x00) >> 17 & 1, 1u);
  b.set("RCC", 0x04, 4u << 8 | 2u << 14 | 1u << 16 | 7u << 18);  // HSE x 9, APB1 / 2, ADC / 6
  b.set("RCC", 0x00, 1 | 1u << 16 | 1u << 24);
  b.set("RCC", 0x04, 2 | 4u << 8 | 2u << 14 | 1u << 16 | 7u << 18);
  EXPECT_EQ(b.get("RCC", 0x04) >> 2 & 3, 2u);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 72e6);
  const ClockTree& clocks = b.chip.context().clocks;
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb1), 36e6);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb2), 72e6);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kAdc), 12e6);
  EXPECT_EQ(clocks.timers(Bus::kApb1), (ClockRatio{1, 1}));
  b.set("RCC", 0x04, 1 | 1u << 16 | 1u << 17 | 7u << 18);  // PLLXTPRE: HSE / 2 x 9
  b.set("RCC", 0x04, 2 | 1u << 16 | 1u << 17 | 7u << 18);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 36e6);
}

// RM0008 table 20: CNF and MODE of a pin.
TEST(F1Parts, PinsAreWhatFourBitsSayOfThem) {
  ChipBench b("stm32f103");
  PinBank& port = *b.chip.port('A');
  EXPECT_EQ(port.mode(0), PinMode::kInput) << "floating after a reset";
  struct Row {
    std::uint32_t bits;
    PinMode mode;
  };
  for (const Row& row : {Row{0x0, PinMode::kAnalog}, Row{0x4, PinMode::kInput}, Row{0x8, PinMode::kInput},
                         Row{0x3, PinMode::kOutput}, Row{0x6, PinMode::kOutput},
                         Row{0xB, PinMode::kAlternate}, Row{0xD, PinMode::kAlternate}}) {
    b.set("GPIOA", 0x04, 0x44444444u ^ (row.bits ^ 4u) << 8);  // pin 10
    EXPECT_EQ(port.mode(10), row.mode) << row.bits;
    EXPECT_EQ(port.mode(9), PinMode::kInput);
  }
}

TEST(F1Parts, OutputsGiveWhatIsSetAndInputsArePulledWhereOdrSays) {
  ChipBench b("stm32f103");
  std::string seen;
  b.chip.port('B')->on_output(3, [&seen](bool level) { seen += level ? '1' : '0'; });
  b.set("GPIOB", 0x00, 0x44443444u | 8u);  // 3: output, 0: pulled
  b.set("GPIOB", 0x10, 1u << 3);
  b.set("GPIOB", 0x10, 1u << (16 + 3));
  b.set("GPIOB", 0x0C, 1u << 3);
  b.set("GPIOB", 0x14, 1u << 3);
  EXPECT_EQ(seen, "1010");
  EXPECT_EQ(b.get("GPIOB", 0x08) & 1u, 0u);
  b.set("GPIOB", 0x00, 0x44443448u);
  b.set("GPIOB", 0x10, 1u);
  EXPECT_EQ(b.get("GPIOB", 0x08) & 1u, 1u) << "pulled up";
  b.chip.port('B')->drive(0, false);
  EXPECT_EQ(b.get("GPIOB", 0x08) & 1u, 0u);
}

TEST(F1Parts, APinsEdgeReachesItsInterruptByAfio) {
  ChipBench b("stm32f103");
  b.set("AFIO", 0x0C, 1u << 4);  // line 5: port B
  b.set("EXTI", 0x00, 1u << 5);
  b.set("EXTI", 0x08, 1u << 5);
  b.chip.port('A')->drive(5, true);
  EXPECT_FALSE(b.system.irq_high[23]);
  b.chip.port('B')->drive(5, true);
  EXPECT_TRUE(b.system.irq_high[23]);
  b.set("EXTI", 0x14, 1u << 5);
  EXPECT_FALSE(b.system.irq_high[23]);
}

struct F1Adc : testing::Test {
  F1Adc() {
    for (const char* adc : {"ADC1", "ADC2"}) {
      for (unsigned c = 0; c < 4; ++c)
        b.chip.find<Adc>(adc)->set_source(c, [c](std::int64_t) { return 3.3 * (c + 1) / 8.0; });
      b.set(adc, 0x08, 1);
    }
  }
  static std::uint32_t code(unsigned channel) { return 4096 * (channel + 1) / 8; }
  ChipBench b{"stm32f103"};
};

// 1.5 + 12.5 clocks of PCLK2 / 2 are 28 cycles (RM0008 11.6).
TEST_F(F1Adc, AdonWrittenAgainConvertsInFourteenClocks) {
  b.set("ADC1", 0x34, 2);  // SQ1
  b.set("ADC1", 0x08, 1);
  b.system.run_for(27);
  EXPECT_EQ(b.get("ADC1", 0x00) & 2u, 0u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("ADC1", 0x00) & 2u, 2u);
  EXPECT_EQ(b.get("ADC1", 0x4C), code(2));
  EXPECT_EQ(b.get("ADC1", 0x00) & 2u, 0u) << "read: EOC is gone";
}

TEST_F(F1Adc, SoftwareStartsOnlyWhereItIsTheTrigger) {
  b.set("ADC1", 0x08, 1 | 1u << 22 | 1u << 20);  // SWSTART, the trigger is TIM1's
  b.system.run_for(100);
  EXPECT_EQ(b.get("ADC1", 0x00), 0u);
  b.set("ADC1", 0x08, 1 | 1u << 22 | 1u << 20 | 7u << 17);
  b.system.run_for(100);
  EXPECT_EQ(b.get("ADC1", 0x00), 2u | 1u << 4);
  EXPECT_EQ(b.get("ADC1", 0x08) & 1u << 22, 0u);
}

TEST_F(F1Adc, InjectedSequencesEndAtTheFourthPlace) {
  b.set("ADC1", 0x04, 1u << 8 | 1u << 7);               // SCAN, JEOCIE
  b.set("ADC1", 0x38, 1u << 20 | 3u << 10 | 1u << 15);  // two: channels 3, 1
  b.set("ADC1", 0x08, 1 | 1u << 21 | 1u << 15 | 7u << 12);
  b.system.run_for(60);
  EXPECT_TRUE(b.system.irq_high[18]);
  EXPECT_EQ(b.get("ADC1", 0x3C), code(3));
  EXPECT_EQ(b.get("ADC1", 0x40), code(1));
}

TEST_F(F1Adc, ARegularSequenceFillsMemoryByDma) {
  b.set("ADC1", 0x04, 1u << 8);
  b.set("ADC1", 0x2C, 2u << 20);
  b.set("ADC1", 0x34, 3u | 1u << 5 | 2u << 10);
  b.set("DMA1", 0x0C, 3);
  b.set("DMA1", 0x10, b.base("ADC1") + 0x4C);
  b.set("DMA1", 0x14, 0x20000000);
  b.set("DMA1", 0x08, 1u << 10 | 1u << 8 | 1u << 7 | 1);
  b.set("ADC1", 0x08, 1 | 1u << 8);
  b.set("ADC1", 0x08, 1 | 1u << 8 | 1u << 22 | 1u << 20 | 7u << 17);
  b.system.run_for(100);
  EXPECT_EQ(b.system.bus_read(0x20000000, 2), code(3));
  EXPECT_EQ(b.system.bus_read(0x20000002, 2), code(1));
  EXPECT_EQ(b.system.bus_read(0x20000004, 2), code(2));
}

TEST_F(F1Adc, RegularSimultaneousPutsTheSlavesResultAbove) {
  b.set("ADC1", 0x04, 6u << 16);
  b.set("ADC1", 0x34, 1);
  b.set("ADC2", 0x34, 3);
  b.set("ADC1", 0x08, 1 | 1u << 22 | 1u << 20 | 7u << 17);
  b.system.run_for(60);
  EXPECT_EQ(b.get("ADC1", 0x4C), code(3) << 16 | code(1));
  EXPECT_EQ(b.get("ADC2", 0x4C), code(3));
}

TEST(F1Parts, SaysWhichItIsAndHowMuchFlashItHas) {
  ChipBench medium("stm32f103"), high("stm32f103ve");
  EXPECT_EQ(medium.get("DBGMCU", 0) & 0xFFF, 0x410u);
  EXPECT_EQ(high.get("DBGMCU", 0) & 0xFFF, 0x414u);
  EXPECT_EQ(medium.system.bus_read(0x1FFFF7E0, 2), 128u);
  EXPECT_EQ(high.system.bus_read(0x1FFFF7E0, 2), 512u);
}

}  // namespace
}  // namespace omnihil::mcu
