// L476: its clocks from the MSI on, request lines that CSELR chooses, flash in two banks, converters (RM0351).
#include <gtest/gtest.h>

#include <string>

#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

TEST(L4Parts, StartsOnTheMsiAndFollowsItsRange) {
  ChipBench b("stm32l476");
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 4e6);
  EXPECT_EQ(b.get("RCC", 0x00) & 3u, 3u) << "on and ready";
  b.set("RCC", 0x00, 1 | 1u << 3 | 11u << 4);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 48e6);
}

TEST(L4Parts, RunsAt80MHzFromItsPllAndGivesTheCardItsClock) {
  ChipBench b("stm32l476");
  b.set("RCC", 0x00, 0x61 | 1u << 16);
  b.set("RCC", 0x0C, 3u | 20u << 8 | 1u << 24);  // HSE 8 MHz x 20 / 2
  b.set("RCC", 0x00, 0x61 | 1u << 16 | 1u << 24);
  b.set("RCC", 0x08, 3u | 4u << 8);  // APB1 / 2
  EXPECT_EQ(b.get("RCC", 0x08) >> 2 & 3, 3u);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 80e6);
  const ClockTree& clocks = b.chip.context().clocks;
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb1), 40e6);
  EXPECT_EQ(clocks.timers(Bus::kApb1), (ClockRatio{1, 1}));
  b.set("RCC", 0x10, 12u << 8 | 0u << 21);  // PLLSAI1: 96 MHz, Q / 2
  b.set("RCC", 0x00, 0x61 | 1u << 16 | 1u << 24 | 1u << 26);
  b.set("RCC", 0x88, 1u << 26);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kSdmmc), 48e6);
}

TEST(L4Parts, AChannelServesTheRequestThatItsSelectionSays) {
  for (const bool chosen : {true, false}) {
    ChipBench b("stm32l476");
    b.system.bus_write(0x20000000, 4, 0x00434241);
    b.set("DMA1", 0xA8, (chosen ? 2u : 3u) << 12);  // channel 4: USART1_TX or I2C2_TX
    b.set("DMA1", 0x44 + 4, 3);
    b.set("DMA1", 0x44 + 8, b.base("USART1") + 0x28);
    b.set("DMA1", 0x44 + 12, 0x20000000);
    b.set("DMA1", 0x44, 1u << 7 | 1u << 4 | 1);
    EXPECT_EQ(b.sent_by_dma("USART1"), chosen ? "ABC" : "");
  }
}

TEST(L4Parts, PagesAreErasedInTheirBank) {
  ChipBench b("stm32l476");
  const std::uint32_t second = 0x08080000;
  b.system.memory[second + 3 * 2048] = 1;
  b.system.memory[0x08000000 + 3 * 2048] = 2;
  b.unlock_flash(0x08);
  b.set("FLASH", 0x14, 2u | 3u << 3 | 1u << 11 | 1u << 16);
  EXPECT_EQ(b.system.memory[second + 3 * 2048], 0xFF);
  EXPECT_EQ(b.system.memory[0x08000000 + 3 * 2048], 2);
  b.set("FLASH", 0x14, 4u | 1u << 16);  // MER1
  EXPECT_EQ(b.system.memory[0x08000000 + 3 * 2048], 0xFF);
}

// 2.5 + 12.5 clocks of HCLK / 4: 60 cycles.
TEST(L4Parts, ConvertsInFifteenClocks) {
  ChipBench b("stm32l476");
  b.chip.find<Adc>("ADC3")->set_source(7, [](std::int64_t) { return 3.3 / 4; });
  b.set("ADC123", 0x08, 3u << 16);
  b.switch_adc_on("ADC3");
  b.set("ADC3", 0x30, 7u << 6);
  b.start_adc("ADC3");
  b.system.run_for(59);
  EXPECT_EQ(b.get("ADC3", 0x00) & 4u, 0u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("ADC3", 0x40), 1024u);
}

TEST(L4Parts, SaysWhichItIs) {
  ChipBench b("stm32l475");
  EXPECT_EQ(b.get("DBGMCU", 0) & 0xFFF, 0x415u);
  EXPECT_EQ(b.system.bus_read(0x1FFF75E0, 2), 1024u);
}

}  // namespace
}  // namespace omnihil::mcu
