// The G0: its clocks, edges that are pending by their direction, one request multiplexer, flash in banks, its converter (RM0444).
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

TEST(G0Parts, StartsOnTheHsiAndFollowsItsDivider) {
  ChipBench b("stm32g071");
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 16e6);
  EXPECT_EQ(b.get("RCC", 0x00), 0x500u) << "on and ready";
  b.set("RCC", 0x00, 0x100 | 3u << 11);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 2e6);
}

TEST(G0Parts, RunsAt64MHzFromItsPllWhateverDividesTheHsi) {
  ChipBench b("stm32g0b1");
  b.set("RCC", 0x00, 0x100 | 3u << 11);
  b.set("RCC", 0x0C, 2u | 8u << 8 | 1u << 28 | 1u << 29 | 1u << 16 | 3u << 17);  // HSI x 8: R / 2, P / 4
  b.set("RCC", 0x00, 0x100 | 3u << 11 | 1u << 24);
  EXPECT_EQ(b.get("RCC", 0x00) >> 25 & 1, 1u);
  b.set("RCC", 0x08, 2u | 5u << 12);  // APB / 4
  EXPECT_EQ(b.get("RCC", 0x08) >> 3 & 7, 2u);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 64e6);
  const ClockTree& clocks = b.chip.context().clocks;
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb1), 16e6);
  EXPECT_EQ(clocks.timers(Bus::kApb1), (ClockRatio{1, 2}));
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kAdc), 64e6);
  b.set("RCC", 0x54, 1u << 30);  // the converter from PLLP
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kAdc), 32e6);
  b.set("RCC", 0x54, 2u << 30);  // from the undivided HSI
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kAdc), 16e6);
}

TEST(G0Parts, APllWhoseOutputIsOffIsNotTaken) {
  ChipBench b("stm32g071");
  b.set("RCC", 0x0C, 2u | 8u << 8 | 1u << 29);
  b.set("RCC", 0x00, 0x100 | 1u << 24);
  b.set("RCC", 0x08, 2u);
  EXPECT_EQ(b.get("RCC", 0x08) >> 3 & 7, 0u);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 16e6);
}

// EXTI's own registers choose ports, eight bits a line; a rising and a falling edge are pending apart.
TEST(G0Parts, EdgesArePendingByTheirDirection) {
  ChipBench b("stm32g071");
  b.set("EXTI", 0x64, 1u << 8);  // line 5: port B
  b.set("EXTI", 0x00, 1u << 5);
  b.set("EXTI", 0x04, 1u << 5);
  b.set("EXTI", 0x80, 1u << 5);
  b.chip.port('A')->drive(5, true);
  EXPECT_EQ(b.get("EXTI", 0x0C), 0u) << "another port";
  b.chip.port('B')->drive(5, true);
  EXPECT_EQ(b.get("EXTI", 0x0C), 1u << 5);
  EXPECT_EQ(b.get("EXTI", 0x10), 0u);
  EXPECT_TRUE(b.system.irq_high[7]);
  b.chip.port('B')->drive(5, false);
  EXPECT_EQ(b.get("EXTI", 0x10), 1u << 5);
  b.set("EXTI", 0x0C, 1u << 5);
  EXPECT_TRUE(b.system.irq_high[7]) << "the falling edge is pending yet";
  b.set("EXTI", 0x10, 1u << 5);
  EXPECT_FALSE(b.system.irq_high[7]);
  b.set("EXTI", 0x08, 1u << 5);  // by software: a rising edge, and the bit reads 0
  EXPECT_EQ(b.get("EXTI", 0x08), 0u);
  EXPECT_EQ(b.get("EXTI", 0x0C), 1u << 5);
}

TEST(G0Parts, AChannelServesTheRequestThatTheMultiplexerSays) {
  for (const bool chosen : {true, false}) {
    ChipBench b("stm32g071");
    b.system.bus_write(0x20000000, 4, 0x00434241);
    b.set("DMAMUX", 4 * 3, chosen ? 51u : 53u);  // USART1_TX or USART2_TX
    b.set("DMA1", 0x44 + 4, 3);
    b.set("DMA1", 0x44 + 8, b.base("USART1") + 0x28);
    b.set("DMA1", 0x44 + 12, 0x20000000);
    b.set("DMA1", 0x44, 1u << 7 | 1u << 4 | 2 | 1);
    EXPECT_EQ(b.sent_by_dma("USART1"), chosen ? "ABC" : "");
    EXPECT_EQ(b.system.irq_high[11], chosen) << "channels 4 to 7 share it";
  }
}

// DMA2 has the multiplexer's channels behind the seven of DMA1 (RM0444 §11.3.1).
TEST(G0Parts, TheSecondControllerFollowsTheFirstOnesChannels) {
  ChipBench b("stm32g0b1");
  b.system.bus_write(0x20000000, 4, 0x00434241);
  b.set("DMAMUX", 4 * 7, 77);  // USART6_TX
  b.set("DMA2", 0x0C, 3);
  b.set("DMA2", 0x10, b.base("USART6") + 0x28);
  b.set("DMA2", 0x14, 0x20000000);
  b.set("DMA2", 0x08, 1u << 7 | 1u << 4 | 1);
  EXPECT_EQ(b.sent_by_dma("USART6"), "ABC");
}

TEST(G0Parts, PagesAreErasedInTheirBank) {
  ChipBench b("stm32g0c1");
  const std::uint32_t first = 0x08000000 + 3 * 2048, second = first + 256 * 1024;
  b.system.memory[first] = 1;
  b.system.memory[second] = 2;
  b.unlock_flash(0x08);
  b.set("FLASH", 0x14, 2u | 3u << 3 | 1u << 13 | 1u << 16);
  EXPECT_EQ(b.system.memory[second], 0xFF);
  EXPECT_EQ(b.system.memory[first], 1);
  b.set("FLASH", 0x14, 4u | 1u << 16);  // MER1
  EXPECT_EQ(b.system.memory[first], 0xFF);
  EXPECT_EQ(b.get("FLASH", 0x10) & 1u, 1u);
}

TEST(G0Parts, AFlashOfOneBankIsErasedWhole) {
  ChipBench b("stm32g071");
  const std::uint32_t last = 0x08000000 + 128 * 1024 - 4;
  b.system.memory[last] = 1;
  b.unlock_flash(0x08);
  b.set("FLASH", 0x14, 4u | 1u << 16);
  EXPECT_EQ(b.system.memory[last], 0xFF);
}

// Places of a sequence, up to the first that is 15: channel 9, then 2; 1.5 and 12.5, then 39.5 and 12.5 clocks of PCLK / 2.
TEST(G0Parts, ConvertsThePlacesOfASequenceWithTheirSamplingTimes) {
  ChipBench b("stm32g071");
  b.chip.find<Adc>("ADC1")->set_source(9, [](std::int64_t) { return 3.3 / 4; });
  b.chip.find<Adc>("ADC1")->set_source(2, [](std::int64_t) { return 3.3 / 2; });
  b.set("ADC1", 0x10, 1u << 30);
  b.set("ADC1", 0x14, 5u << 4 | 1u << (8 + 2));
  b.set("ADC1", 0x00, 1u << 13);
  b.set("ADC1", 0x0C, 1u << 21);
  b.set("ADC1", 0x28, 0xFFFFFF29);
  EXPECT_EQ(b.get("ADC1", 0x00) >> 13 & 1, 1u) << "CCRDY";
  b.switch_adc_on("ADC1");
  b.start_adc("ADC1");
  b.system.run_for(27);
  EXPECT_EQ(b.get("ADC1", 0x00) & 4u, 0u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("ADC1", 0x40), 1024u);
  EXPECT_EQ(b.get("ADC1", 0x00) & 8u, 0u) << "one is left";
  b.system.run_for(103);
  EXPECT_EQ(b.get("ADC1", 0x00) & 8u, 0u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("ADC1", 0x40), 2048u);
  EXPECT_EQ(b.get("ADC1", 0x00) & 8u, 8u);
}

// 1.5 and 12.5 clocks of PCLK: 14 cycles of the core for each conversion, whatever part of it sampling is.
TEST(G0Parts, ConvertsSelectedChannelsUpwards) {
  ChipBench b("stm32g031");
  b.chip.find<Adc>("ADC1")->set_source(4, [](std::int64_t) { return 3.3 / 8; });
  b.set("ADC1", 0x10, 3u << 30);  // PCLK
  b.set("ADC1", 0x28, 1u << 4 | 1u << 13);
  b.switch_adc_on("ADC1");
  b.start_adc("ADC1");
  b.system.run_for(13);
  EXPECT_EQ(b.get("ADC1", 0x00) & 4u, 0u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("ADC1", 0x40), 512u);
  b.system.run_for(13);
  EXPECT_EQ(b.get("ADC1", 0x00) & 4u, 0u);
  b.system.run_for(1);
  EXPECT_NEAR(b.get("ADC1", 0x40), 1.212 / 3.3 * 4096, 1.0) << "VREFINT";
}

TEST(G0Parts, EachSizeHasWhatTheOneBeforeItHas) {
  const ChipBench tiny("stm32g041"), small("stm32g061"), middle("stm32g081"), large("stm32g0b1");
  for (const auto& [less, more] : {std::pair{&tiny, &small}, {&small, &middle}, {&middle, &large}}) {
    for (const Chip::Mapped& block : less->chip.blocks())
      EXPECT_EQ(more->base(block.peripheral->name()), block.base) << block.peripheral->name();
  }
  for (const char* block : {"TIM6", "TIM15"}) EXPECT_EQ(tiny.base(block), 0u) << block;
  for (const char* block : {"USART3", "CEC"}) EXPECT_EQ(small.base(block), 0u) << block;
  for (const char* block : {"TIM4", "DMA2", "FDCAN1", "SPI3", "I2C3", "GPIOE", "USART6"}) {
    EXPECT_EQ(middle.base(block), 0u) << block;
    EXPECT_NE(large.base(block), 0u) << block;
  }
}

// RM0454: the value line lacks these of its sibling's blocks, and has nothing else elsewhere.
TEST(G0Parts, TheValueLineHasItsSiblingsBlocksButForSome) {
  const std::set<std::string> lacked{"TIM2",    "LPUART1", "LPUART2", "LPTIM1", "LPTIM2",
                                     "VREFBUF", "DAC1",    "COMP",    "CEC",    "UCPD1",
                                     "UCPD2",   "FDCAN1",  "FDCAN2",  "CRS",    "FDCAN message RAM"};
  for (const auto& [value, full] : {std::pair{"stm32g030", "stm32g031"},
                                    {"stm32g050", "stm32g051"},
                                    {"stm32g070", "stm32g071"},
                                    {"stm32g0b0", "stm32g0b1"}}) {
    const ChipBench less(value), more(full);
    for (const Chip::Mapped& block : more.chip.blocks()) {
      const std::string& name = block.peripheral->name();
      EXPECT_EQ(less.base(name), lacked.contains(name) ? 0u : block.base) << value << " " << name;
    }
    for (const Chip::Mapped& block : less.chip.blocks())
      EXPECT_EQ(more.base(block.peripheral->name()), block.base) << value;
  }
}

TEST(G0Parts, SaysWhichItIsAndHowMuchFlashItHas) {
  for (const auto& [name, id, kib] : {std::tuple{"stm32g031", 0x466u, 64u},
                                      {"stm32g051", 0x456u, 64u},
                                      {"stm32g071", 0x460u, 128u},
                                      {"stm32g0b1", 0x467u, 512u},
                                      {"stm32g030", 0x466u, 64u},
                                      {"stm32g050", 0x456u, 64u},
                                      {"stm32g070", 0x460u, 128u},
                                      {"stm32g0b0", 0x467u, 512u}}) {
    ChipBench b(name);
    EXPECT_EQ(b.get("DBGMCU", 0) & 0xFFF, id);
    EXPECT_EQ(b.system.bus_read(0x1FFF75E0, 2), kib);
  }
}

}  // namespace
}  // namespace omnihil::mcu
