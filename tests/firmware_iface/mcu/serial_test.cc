// Serial ports with interrupts, DMA and idle line, on both register layouts and both DMA controllers.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

struct Sent {
  std::uint8_t byte;
  Cycles end;
};

TEST(Serial, AFrameTakesTenBitTimes) {
  ChipBench b("stm32f405");
  std::vector<Sent> sent;
  b.chip.find<Usart>("USART1")->on_transmit([&](std::uint8_t byte, Cycles end) {
    sent.push_back({byte, end});
  });
  b.set("USART1", 0x08, 16);  // 16 MHz / 16 = 1 Mbaud
  b.set("USART1", 0x0C, 1u << 13 | 1u << 3 | 1u << 2);
  b.set("USART1", 0x04, 0xA5);
  EXPECT_EQ(b.get("USART1", 0x00) >> 7 & 1, 1u);  // the shift register took it
  b.set("USART1", 0x04, 0x5A);
  EXPECT_EQ(b.get("USART1", 0x00) >> 7 & 1, 0u);
  b.system.run_for(320);
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].byte, 0xA5);
  EXPECT_EQ(sent[0].end, 160u);
  EXPECT_EQ(sent[1].end, 320u);
  EXPECT_EQ(b.get("USART1", 0x00) >> 6 & 1, 1u);  // TC
}

TEST(Serial, ReceivesAtTheEndOfTheFrameAndCountsOverruns) {
  ChipBench b("stm32f405");
  Usart& port = *b.chip.find<Usart>("USART1");
  b.set("USART1", 0x08, 16);
  b.set("USART1", 0x0C, 1u << 13 | 1u << 2 | 1u << 5);
  port.feed(std::array<std::uint8_t, 3>{1, 2, 3}, 0);
  b.system.run_until(159);
  EXPECT_FALSE(b.system.irq_high[37]);
  b.system.run_until(160);
  EXPECT_TRUE(b.system.irq_high[37]);
  EXPECT_EQ(b.get("USART1", 0x04), 1u);
  EXPECT_FALSE(b.system.irq_high[37]);
  b.system.run_until(480);
  EXPECT_EQ(b.get("USART1", 0x00) >> 3 & 1, 1u);  // ORE
  EXPECT_EQ(port.overruns(), 1u);
  EXPECT_EQ(b.get("USART1", 0x04), 2u);
  EXPECT_EQ(b.get("USART1", 0x00) >> 3 & 1, 0u);
}

TEST(Serial, LineIsIdleOneFrameAfterTheLastByte) {
  for (const char* name : {"stm32f405", "stm32f767"}) {
    ChipBench b(name);
    const bool v2 = std::string(name) == "stm32f767";
    b.set("USART1", v2 ? 0x0C : 0x08, 16);
    b.set("USART1", v2 ? 0x00 : 0x0C, (v2 ? 1u : 1u << 13) | 1u << 2 | 1u << 4);
    b.chip.find<Usart>("USART1")->feed(std::array<std::uint8_t, 2>{1, 2}, 0);
    b.system.run_until(320 + 159);
    EXPECT_FALSE(b.system.irq_high[37]);
    b.system.run_until(320 + 160);
    EXPECT_TRUE(b.system.irq_high[37]);
  }
}

TEST(Serial, DmaOfStreamsSendsABufferAndTellsOfItsEnd) {
  ChipBench b("stm32f407");
  std::string sent;
  b.chip.find<Usart>("USART1")->on_transmit(
      [&](std::uint8_t byte, Cycles) { sent += static_cast<char>(byte); });
  const std::string text = "hello robot";
  for (std::size_t i = 0; i < text.size(); ++i)
    b.system.memory[0x20000000 + i] = static_cast<std::uint8_t>(text[i]);
  b.set("USART1", 0x08, 16);
  b.set("USART1", 0x14, 1u << 7);
  b.set("USART1", 0x0C, 1u << 13 | 1u << 3);
  constexpr std::uint32_t kStream7 = 0x10 + 24 * 7;
  b.set("DMA2", kStream7 + 4, static_cast<std::uint32_t>(text.size()));
  b.set("DMA2", kStream7 + 8, b.base("USART1") + 4);
  b.set("DMA2", kStream7 + 12, 0x20000000);
  b.set("DMA2", kStream7, 4u << 25 | 1u << 10 | 1u << 6 | 1u << 4 | 1);
  b.system.run_for(160 * (text.size() - 2) - 1);
  EXPECT_FALSE(b.system.irq_high[70]);
  b.system.run_for(1000);
  EXPECT_TRUE(b.system.irq_high[70]);
  EXPECT_EQ(sent, text);
  EXPECT_EQ(b.get("DMA2", kStream7) & 1, 0u);
  EXPECT_EQ(b.get("DMA2", kStream7 + 4), 0u);
  b.set("DMA2", 0x0C, 0x3Du << 22);
  EXPECT_FALSE(b.system.irq_high[70]);
}

TEST(Serial, CircularDmaOfChannelsReceivesForEver) {
  ChipBench b("stm32f031");
  b.set("USART1", 0x0C, 16);
  b.set("USART1", 0x08, 1u << 6);
  b.set("USART1", 0x00, 1 | 1u << 2);
  EXPECT_EQ(b.get("USART1", 0x1C) >> 22 & 1, 1u);  // REACK
  constexpr std::uint32_t kChannel3 = 0x08 + 20 * 2;
  b.set("DMA1", kChannel3 + 4, 8);
  b.set("DMA1", kChannel3 + 8, b.base("USART1") + 0x24);
  b.set("DMA1", kChannel3 + 12, 0x20000100);
  b.set("DMA1", kChannel3, 1u << 7 | 1u << 5 | 1u << 2 | 1u << 1 | 1);
  std::vector<std::uint8_t> bytes;
  for (unsigned i = 0; i < 21; ++i) bytes.push_back(static_cast<std::uint8_t>(i + 1));
  b.chip.find<Usart>("USART1")->feed(bytes, 0);
  b.system.run_for(100'000);
  EXPECT_EQ(b.get("DMA1", kChannel3 + 4), 8u - 21 % 8);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t last = 16 + i < 21 ? 16 + i : 8 + i;
    EXPECT_EQ(b.system.memory[0x20000100 + i], last + 1);
  }
  EXPECT_TRUE(b.system.irq_high[10]);
}

TEST(Serial, RequestMultiplexerOfG4RoutesByNumber) {
  ChipBench b("stm32g474");
  std::string sent;
  b.chip.find<Usart>("USART1")->on_transmit(
      [&](std::uint8_t byte, Cycles) { sent += static_cast<char>(byte); });
  b.system.memory[0x20000000] = 'o';
  b.system.memory[0x20000001] = 'k';
  b.set("DMAMUX", 4 * 8, 25);  // DMA2 channel 1: USART1_TX
  b.set("USART1", 0x0C, 16);
  b.set("USART1", 0x08, 1u << 7);
  b.set("USART1", 0x00, 1 | 1u << 3);
  b.set("DMA2", 0x0C, 2);
  b.set("DMA2", 0x10, b.base("USART1") + 0x28);
  b.set("DMA2", 0x14, 0x20000000);
  b.set("DMA2", 0x08, 1u << 7 | 1u << 4 | 1);
  b.system.run_for(1000);
  EXPECT_EQ(sent, "ok");
}

TEST(Dma, MemoryToMemoryWidensItems) {
  ChipBench b("stm32f303");
  for (std::uint8_t i = 0; i < 4; ++i) b.system.memory[0x20000000u + i] = static_cast<std::uint8_t>(0xA0 + i);
  b.set("DMA1", 0x0C, 4);
  b.set("DMA1", 0x10, 0x20000000);
  b.set("DMA1", 0x14, 0x20001000);
  b.set("DMA1", 0x08, 1u << 14 | 2u << 10 | 1u << 7 | 1u << 6 | 1);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(b.system.read(0x20001000 + 4 * i), 0xA0 + i);
}

TEST(Dma, TimerUpdatesMoveOneItemEach) {
  ChipBench b("stm32f407");
  constexpr std::uint32_t kStream5 = 0x10 + 24 * 5;
  for (std::uint32_t i = 0; i < 4; ++i)
    b.system.memory[0x20000000 + 2 * i] = static_cast<std::uint8_t>(10 * (i + 1));
  b.set("DMA2", kStream5 + 4, 4);
  b.set("DMA2", kStream5 + 8, b.base("TIM1") + 0x34);
  b.set("DMA2", kStream5 + 12, 0x20000000);
  b.set("DMA2", kStream5, 6u << 25 | 1u << 13 | 1u << 11 | 1u << 10 | 1u << 8 | 1u << 6 | 1);
  b.set("TIM1", 0x2C, 99);
  b.set("TIM1", 0x0C, 1u << 8);
  b.set("TIM1", 0x00, 1);
  for (std::uint32_t i = 0; i < 9; ++i) {
    b.system.run_for(100);
    EXPECT_EQ(b.get("TIM1", 0x34), 10 * (i % 4 + 1));
  }
}

}  // namespace
}  // namespace omnihil::mcu
