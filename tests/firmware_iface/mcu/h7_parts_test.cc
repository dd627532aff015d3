// H743, H723: clocks with kernel clocks, memories, request lines, ports' interrupts, flash in banks (RM0433, RM0468).
#include <gtest/gtest.h>

#include <string>

#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

// HSE 8 MHz / 1 x 100 = 800 MHz: P 400 (the core's), Q 200, and behind HPRE 2, D2PPRE1 2, D2PPRE2 2.
struct H7Clocks : testing::Test {
  H7Clocks() {
    b.set("RCC", 0x00, 1 | 1u << 16);
    b.set("RCC", 0x28, 2 | 1u << 4 | 1u << 12 | 1u << 20);
    b.set("RCC", 0x30, 99u | 1u << 9 | 3u << 16 | 1u << 24);
    b.set("RCC", 0x18, 8);  // HPRE / 2
    b.set("RCC", 0x1C, 4u << 4 | 4u << 8);
    b.set("RCC", 0x20, 5u << 4);  // D3PPRE / 4
    b.set("RCC", 0x00, 1 | 1u << 16 | 1u << 24);
    b.set("RCC", 0x10, 3);
  }
  ChipBench b{"stm32h743"};
  ClockTree& clocks = b.chip.context().clocks;
};

TEST_F(H7Clocks, RunsAt400MHzWithItsBusesAndTimersBehindTheirPrescalers) {
  EXPECT_EQ(b.get("RCC", 0x10) >> 3 & 7, 3u);
  EXPECT_EQ(b.get("RCC", 0x00) & 1u << 25, 1u << 25);
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 400e6);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kAhb), 200e6);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb1), 100e6);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb2), 100e6);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kApb4), 50e6);
  EXPECT_EQ(clocks.timers(Bus::kApb1), (ClockRatio{1, 2}));  // 200 MHz
  b.set("RCC", 0x1C, 5u << 4 | 4u << 8);                     // APB1 / 4: twice 50 MHz
  EXPECT_EQ(clocks.timers(Bus::kApb1), (ClockRatio{1, 4}));
  b.set("RCC", 0x10, 3 | 1u << 15);  // TIMPRE: HCLK up to a divider of 4
  EXPECT_EQ(clocks.timers(Bus::kApb1), (ClockRatio{1, 2}));
}

TEST_F(H7Clocks, KernelClocksComeFromWhereTheyAreChosen) {
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kSpi123), 200e6) << "PLL1's Q";
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kUsartRest), 100e6);
  b.set("RCC", 0x54, 3);  // USART2 to 8 from the HSI
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kUsartRest), 64e6);
  b.set("RCC", 0x00, 1 | 1u << 3 | 1u << 16 | 1u << 24);  // HSI / 2
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kUsartRest), 32e6);
  b.set("RCC", 0x50, 0u << 28);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kFdcan), 8e6) << "HSE";
  // PLL2: 8 MHz x (30 + 1 + 4096/8192) / 3 = 84 MHz at P
  b.set("RCC", 0x38, 30u | 2u << 9 | 1u << 16 | 1u << 24);
  b.set("RCC", 0x3C, 4096u << 3);
  b.set("RCC", 0x2C, 0x01FF0000u | 1u << 4);
  EXPECT_TRUE((clocks.state().off >> static_cast<unsigned>(Bus::kAdc) & 1u) != 0);
  b.set("RCC", 0x00, 1 | 1u << 16 | 1u << 24 | 1u << 26);
  EXPECT_DOUBLE_EQ(clocks.bus_hz(Bus::kAdc), 84e6);
}

TEST_F(H7Clocks, ABlockWhoseKernelClockIsOffSaysSo) {
  b.set("ADC1", 0x08, 1u << 28 | 1);
  EXPECT_EQ(b.system.unmodelled.count("ADC1: its kernel clock is off; that of its bus is taken"), 1u);
}

TEST_F(H7Clocks, ASerialPortSendsAtItsKernelClocksRateOverItsPrescaler) {
  b.set("RCC", 0x54, 3);       // HSI, 64 MHz
  b.set("USART3", 0x2C, 1);    // PRESC / 2
  b.set("USART3", 0x0C, 278);  // 32 MHz / 278 = 115.1 kBd
  b.set("USART3", 0x00, 1u << 3 | 1u << 2 | 1);
  EXPECT_NEAR(b.chip.find<Usart>("USART3")->baud(), 64e6 / 2 / 278, 1.0 / 3472 * 115200);
}

TEST(H7Parts, HasWhatItsManualListsByChip) {
  const ChipBench h743("stm32h743"), h723("stm32h723");
  for (const char* block : {"TIM23", "UART9", "USART10", "I2C5", "FDCAN3", "CORDIC"}) {
    EXPECT_EQ(h743.base(block), 0u) << block;
    EXPECT_NE(h723.base(block), 0u) << block;
  }
  EXPECT_NE(h743.base("GPIOI"), 0u);
  EXPECT_EQ(h723.base("GPIOI"), 0u);
}

TEST(H7Parts, VoltageScalingAndRegulatorsAreReady) {
  ChipBench b("stm32h743");
  b.set("PWR", 0x18, 3u << 14);
  EXPECT_EQ(b.get("PWR", 0x18), 3u << 14 | 1u << 13);
  EXPECT_EQ(b.get("PWR", 0x04), 3u << 14 | 1u << 13);
  b.set("PWR", 0x0C, 1u << 24 | 6);
  EXPECT_EQ(b.get("PWR", 0x0C) >> 26 & 1, 1u);
}

TEST(H7Parts, SaysWhyItWasReset) {
  ChipBench b("stm32h743");
  EXPECT_EQ(b.get("RCC", 0xD0) & (1u << 23), 1u << 23);
  b.system.cause = "IWDG";
  b.chip.reset();
  EXPECT_EQ(b.get("RCC", 0xD0), 1u << 22 | 1u << 26);
  EXPECT_EQ(b.get("RCC", 0x130), 1u << 22 | 1u << 26) << "the core's own view";
  b.set("RCC", 0xD0, 1u << 16);
  EXPECT_EQ(b.get("RCC", 0xD0), 0u);
}

TEST(H7Parts, APinsEdgeReachesTheCoreByItsOwnMask) {
  ChipBench b("stm32h743");
  b.set("SYSCFG", 0x0C, 2u << 4);  // line 5: port C
  b.set("EXTI", 0x00, 1u << 5);
  b.chip.port('C')->drive(5, true);
  EXPECT_FALSE(b.system.irq_high[23]) << "masked";
  b.chip.port('C')->drive(5, false);
  b.set("EXTI", 0x80, 1u << 5);
  b.chip.port('C')->drive(5, true);
  EXPECT_TRUE(b.system.irq_high[23]);
  EXPECT_EQ(b.get("EXTI", 0x88), 1u << 5);
  b.set("EXTI", 0x88, 1u << 5);
  EXPECT_FALSE(b.system.irq_high[23]);
}

// Stream 0 of DMA2 hangs on channel 8 of the multiplexer.
TEST(H7Parts, StreamsFollowTheRequestMultiplexer) {
  ChipBench b("stm32h743");
  b.set("DMAMUX1", 4 * 8, 46);  // USART3_TX
  b.system.bus_write(0x24000000, 4, 0x44434241);
  b.set("DMA2", 0x14, 3);
  b.set("DMA2", 0x18, b.base("USART3") + 0x28);
  b.set("DMA2", 0x1C, 0x24000000);
  b.set("DMA2", 0x10, 1u << 10 | 1u << 6 | 1u << 4 | 1);
  EXPECT_EQ(b.sent_by_dma("USART3"), "ABC");
  EXPECT_TRUE(b.system.irq_high[56]);
}

TEST(H7Parts, SectorsAreErasedInTheirBankAndProgrammed) {
  ChipBench b("stm32h743");
  const std::uint32_t second = 0x08100000;  // bank 2
  b.system.memory[second + 0x20000] = 0x12;
  b.system.memory[0x08020000] = 0x34;
  b.set("FLASH", 0x10C, 1u << 2 | 1u << 8 | 1u << 7);
  EXPECT_EQ(b.system.memory[second + 0x20000], 0x12) << "locked";
  b.unlock_flash(0x104);
  b.set("FLASH", 0x10C, 1u << 2 | 1u << 8 | 1u << 7);
  EXPECT_EQ(b.system.memory[second + 0x20000], 0xFF);
  EXPECT_EQ(b.system.memory[0x08020000], 0x34) << "the other bank's";
  EXPECT_EQ(b.get("FLASH", 0x110), 1u << 16);
  b.set("FLASH", 0x114, 1u << 16);
  EXPECT_EQ(b.get("FLASH", 0x110), 0u);
  b.set("FLASH", 0x10C, 2);
  b.chip.flash()->flash_write(second + 0x20000, 4, 0x0BADF00D);
  EXPECT_EQ(b.system.bus_read(second + 0x20000, 4), 0x0BADF00Du);
  b.chip.flash()->flash_write(0x08020000, 4, 0);
  EXPECT_EQ(b.system.memory[0x08020000], 0x34) << "its bank is not being programmed";
}

// 16 bits: half scale is 32768; 1.5 + 8.5 clocks of HCLK / 1, halved by revision V: 20 cycles.
TEST(H7Parts, ConvertsSixteenBits) {
  ChipBench b("stm32h743");
  b.chip.find<Adc>("ADC1")->set_source(4, [](std::int64_t) { return 1.65; });
  b.set("ADC12", 0x08, 1u << 16);
  b.switch_adc_on("ADC1");
  b.set("ADC1", 0x30, 4u << 6);
  b.start_adc("ADC1");
  b.system.run_for(19);
  EXPECT_EQ(b.get("ADC1", 0x00) & 4u, 0u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("ADC1", 0x00) & 4u, 4u);
  EXPECT_EQ(b.get("ADC1", 0x40), 32768u);
  b.set("ADC1", 0x0C, 7u << 2);  // 8 bits
  b.start_adc("ADC1");
  b.system.run_for(100);
  EXPECT_EQ(b.get("ADC1", 0x40), 128u);
}

TEST(H7Parts, SaysWhichItIsAndHowMuchFlashItHas) {
  ChipBench h743("stm32h743"), h723("stm32h723"), h750("stm32h750");
  EXPECT_EQ(h743.get("DBGMCU", 0) & 0xFFF, 0x450u);
  EXPECT_EQ(h723.get("DBGMCU", 0) & 0xFFF, 0x483u);
  EXPECT_EQ(h743.system.bus_read(0x1FF1E880, 2), 2048u);
  EXPECT_EQ(h750.system.bus_read(0x1FF1E880, 2), 128u);
}

}  // namespace
}  // namespace omnihil::mcu
