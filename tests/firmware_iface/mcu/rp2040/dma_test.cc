// DMA, ADC and watchdog of the RP2040 against §2.5, §4.9 and §4.7 of its datasheet.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/adc/adc.h"
#include "tests/firmware_iface/mcu/rp2040/rp2040_bench.h"

namespace omnihil::mcu {
namespace {
constexpr std::uint32_t kRam = 0x20000000;
constexpr std::uint32_t kOn = 1, kWords = 2u << 2, kReadOn = 1u << 4, kWriteOn = 1u << 5,
                        kAtOnce = 0x3Fu << 15;
constexpr std::uint32_t chain(std::uint32_t to) { return to << 11; }
constexpr std::uint32_t request(std::uint32_t which) { return which << 15; }

struct DmaBench : Rp2040Bench {
  void start(std::uint32_t channel, std::uint32_t from, std::uint32_t to, std::uint32_t count,
             std::uint32_t control) {
    set("DMA", 0x40 * channel + 0x00, from);
    set("DMA", 0x40 * channel + 0x04, to);
    set("DMA", 0x40 * channel + 0x08, count);
    set("DMA", 0x40 * channel + 0x0C, control);
  }
  std::uint32_t word(std::uint32_t at) { return system.bus_read(kRam + at, 4); }
};

// RING_SIZE 4: the address goes round in 16 bytes that begin at a multiple of 16.
TEST(Rp2040Dma, ARingOfTheReadAddressRepeatsItsWords) {
  DmaBench b;
  for (std::uint32_t i = 0; i < 4; ++i) b.system.bus_write(kRam + 4 * i, 4, 100 + i);
  b.start(0, kRam + 8, kRam + 0x100, 10, kOn | kWords | kReadOn | kWriteOn | 4u << 6 | kAtOnce);
  for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(b.word(0x100 + 4 * i), 100 + (i + 2) % 4) << i;
  EXPECT_EQ(b.get("DMA", 0x00), kRam) << "8 + 40 is 0 of 16";
  EXPECT_EQ(b.get("DMA", 0x04), kRam + 0x100 + 40);
}

TEST(Rp2040Dma, ARingOfTheWriteAddressKeepsTheLastItems) {
  DmaBench b;
  for (std::uint32_t i = 0; i < 10; ++i) b.system.bus_write(kRam + i, 1, i);
  b.start(0, kRam, kRam + 0x100, 10, kOn | kReadOn | kWriteOn | 2u << 6 | 1u << 10 | kAtOnce);
  EXPECT_EQ(b.word(0x100), 8u | 9u << 8 | 6u << 16 | 7u << 24);
}

// The control blocks of §2.5.6.2: channel 0 writes the next two words into channel 1's last registers and is started by it.
TEST(Rp2040Dma, ControlBlocksRunUntilTheirNullTrigger) {
  DmaBench b;
  const char text[] = "onetwo";
  for (std::uint32_t i = 0; i < 6; ++i) b.system.bus_write(kRam + i, 1, static_cast<std::uint8_t>(text[i]));
  const std::uint32_t blocks[] = {3, kRam, 3, kRam + 3,
                                  0, 0};  // lengths, addresses; AL3: …, TRANS_COUNT, READ_ADDR_TRIG
  for (std::uint32_t i = 0; i < 6; ++i) b.system.bus_write(kRam + 0x40 + 4 * i, 4, blocks[i]);
  b.set("DMA", 0x44, kRam + 0x100);
  b.set("DMA", 0x40 + 0x10, kOn | kReadOn | kWriteOn | chain(0) | 1u << 21 | kAtOnce);  // no trigger; quiet
  b.start(0, kRam + 0x40, 0x50000000 + 0x40 + 0x38, 2,
          kOn | kWords | kReadOn | kWriteOn | 3u << 6 | 1u << 10 | kAtOnce);
  std::string copied;
  for (std::uint32_t i = 0; i < 6; ++i) copied += static_cast<char>(b.system.bus_read(kRam + 0x100 + i, 1));
  EXPECT_EQ(copied, text);
  EXPECT_NE(b.get("DMA", 0x400) & 2, 0u) << "the null trigger";
}

TEST(Rp2040Dma, TransCountIsWhatIsLeftAndEachTriggerTakesItAnew) {
  DmaBench b;
  b.start(0, kRam, kRam + 0x100, 5, kOn | kWords | kReadOn | kAtOnce);
  EXPECT_EQ(b.get("DMA", 0x08), 0u) << "nothing is left";
  b.set("DMA", 0x430, 1);
  EXPECT_EQ(b.get("DMA", 0x00), kRam + 4 * 10);
  b.start(1, kRam, kRam + 0x100, 5, kOn | kWords | request(0x3B));
  EXPECT_EQ(b.get("DMA", 0x48), 5u) << "TIMER0 stands";
  EXPECT_NE(b.get("DMA", 0x4C) & 1u << 24, 0u) << "busy";
  b.set("DMA", 0x444, 2);
  EXPECT_EQ(b.get("DMA", 0x4C) & 1u << 24, 0u);
}

// A pacing timer gives X of Y cycles' requests.
TEST(Rp2040Dma, APacingTimersRateIsItsFraction) {
  struct Row {
    std::uint32_t x, y;
  };
  for (const Row row : {Row{1, 7}, {2, 5}, {3, 100}, {2, 3}, {999, 1000}}) {
    DmaBench b;
    b.set("DMA", 0x420, row.x << 16 | row.y);
    b.start(0, kRam, kRam + 0x100, 100'000, kOn | kWords | request(0x3B));
    b.system.run_for(30'000);
    EXPECT_NEAR(100'000 - static_cast<double>(b.get("DMA", 0x08)), 30'000.0 * row.x / row.y, 1.0)
        << row.x << "/" << row.y;
  }
}

TEST(Rp2040Dma, ChannelsThatStartEachOtherKeepTheirTimersPace) {
  DmaBench b;
  b.set("DMA", 0x420, 1u << 16 | 10);
  b.start(1, kRam, kRam + 0x200, 5, kOn | kWords | kWriteOn | request(0x3B) | chain(0));
  b.set("DMA", 0x444, 2);
  b.set("DMA", 0x44, kRam + 0x200);
  b.start(0, kRam, kRam + 0x100, 5, kOn | kWords | kWriteOn | request(0x3B) | chain(1));
  b.system.run_for(10'000);
  const std::uint32_t moved = (b.get("DMA", 0x04) - kRam - 0x100 + b.get("DMA", 0x44) - kRam - 0x200) / 4;
  EXPECT_NEAR(moved, 1000.0, 1.0);
}

TEST(Rp2040Dma, ATimerThatIsSetAfterItsChannelHasBegunPacesIt) {
  DmaBench b;
  b.start(0, kRam, kRam + 0x100, 100, kOn | kWords | request(0x3C));
  b.system.run_for(1000);
  EXPECT_EQ(b.get("DMA", 0x08), 100u);
  b.set("DMA", 0x424, 1u << 16 | 50);
  b.system.run_for(1000);
  EXPECT_NEAR(b.get("DMA", 0x08), 80.0, 1.0);
}

TEST(Rp2040Dma, AWrapOfPwmMovesOneItem) {
  DmaBench b;
  for (std::uint32_t i = 0; i < 4; ++i) b.system.bus_write(kRam + 4 * i, 4, 10 * (i + 1));
  b.set("PWM", 0x10, 99);
  b.start(0, kRam, 0x4005000C, 4, kOn | kWords | kReadOn | request(24));
  b.set("PWM", 0x00, 1);
  for (std::uint32_t i = 0; i < 4; ++i) {
    b.system.run_for(99);
    EXPECT_EQ(b.get("DMA", 0x08), 4 - i);
    b.system.run_for(1);
    EXPECT_EQ(b.get("DMA", 0x08), 3 - i);
    EXPECT_EQ(b.get("PWM", 0x0C), 10 * (i + 1));
  }
}

TEST(Rp2040Dma, AReceivingUartIsReadAsItsBytesCome) {
  DmaBench b;
  b.set("UART0", 0x24, 10);
  b.set("UART0", 0x2C, 0x70);
  b.set("UART0", 0x30, 0x301);
  b.set("UART0", 0x48, 1);
  b.set("DMA", 0x404, 1u << 3);
  b.start(3, 0x40034000, kRam, 3, kOn | kWriteOn | chain(3) | request(21));
  const std::vector<std::uint8_t> bytes{'a', 'b', 'c'};
  b.chip.find<SerialPort>("UART0")->feed(bytes, b.system.to_ns(b.system.now()));
  b.system.run_for(2 * 10 * 160 + 10);
  EXPECT_EQ(b.get("DMA", 0x40 * 3 + 8), 1u);
  EXPECT_FALSE(b.system.irq_high[11]);
  b.system.run_for(10 * 160);
  EXPECT_EQ(b.word(0) & 0xFFFFFF, 0x636261u);
  EXPECT_TRUE(b.system.irq_high[11]);
  b.set("DMA", 0x40C, 1u << 3);
  EXPECT_FALSE(b.system.irq_high[11]);
}

// 96 clocks of clk_adc a conversion; INTR and DREQ from THRESH on.
struct AdcBench : DmaBench {
  static constexpr double kCycles = 96 * 125 / 12.0;
  AdcBench() {
    set("CLOCKS", 0x60, 1u << 11 | 3u << 5);
    for (unsigned i = 0; i < 4; ++i) chip.find<Adc>("ADC")->set_voltage(i, 3.3 * (i + 1) * 500 / 4096);
    set("ADC", 0x08, 1);
  }
  void run(double conversions) { system.run_for(static_cast<Cycles>(std::llround(conversions * kCycles))); }
};

TEST(Rp2040Adc, TheInterruptFollowsTheFifosLevel) {
  AdcBench b;
  b.set("ADC", 0x08, 1 | 3u << 24);
  b.set("ADC", 0x18, 1);
  b.set("ADC", 0x00, 1);
  b.set("ADC", 0x00, 1 | 1u << 3);
  b.run(2.9);
  EXPECT_FALSE(b.system.irq_high[22]);
  b.run(0.2);
  EXPECT_TRUE(b.system.irq_high[22]);
  b.get("ADC", 0x0C);
  EXPECT_FALSE(b.system.irq_high[22]);
}

TEST(Rp2040Adc, AFullFifoLosesWhatComesAndAnEmptyOneSaysThatItWasRead) {
  AdcBench b;
  b.set("ADC", 0x00, 1);
  b.set("ADC", 0x00, 1 | 1u << 3);
  b.run(4.5);
  EXPECT_EQ(b.get("ADC", 0x08) & (1u << 11 | 1u << 9), 1u << 9);
  b.run(1);
  EXPECT_NE(b.get("ADC", 0x08) & 1u << 11, 0u);
  b.set("ADC", 0x00, 1);
  b.run(1.5);
  for (int i = 0; i < 5; ++i) b.get("ADC", 0x0C);
  EXPECT_NE(b.get("ADC", 0x08) & 1u << 10, 0u);
  b.set("ADC", 0x08 + kSet, 3u << 10);
  EXPECT_EQ(b.get("ADC", 0x08) & 3u << 10, 0u);
}

TEST(Rp2040Adc, AnInputOutsideOfTheRoundIsTakenFirstAndOnce) {
  AdcBench b;
  b.set("ADC", 0x00, 1 | 6u << 16);  // inputs 1 and 2 in turn, AINSEL 0
  b.set("ADC", 0x00, 1 | 6u << 16 | 1u << 3);
  const std::uint32_t wanted[] = {500, 1000, 1500, 1000, 1500, 1000, 1500};
  for (const std::uint32_t code : wanted) {
    b.run(1);
    b.system.run_for(2);
    EXPECT_EQ(b.get("ADC", 0x0C), code);
  }
}

TEST(Rp2040Adc, OneByOneTheRoundGoesOnToo) {
  AdcBench b;
  b.set("ADC", 0x00, 1 | 0xAu << 16 | 3u << 12);
  const std::uint32_t wanted[] = {2000, 1000, 2000, 1000}, next[] = {1, 3, 1, 3};
  for (std::size_t i = 0; i < 4; ++i) {
    b.set("ADC", 0x00 + kSet, 1u << 2);
    b.run(1.1);
    EXPECT_EQ(b.get("ADC", 0x04), wanted[i]) << i;
    EXPECT_EQ(b.get("ADC", 0x00) >> 12 & 7, next[i]) << i;
    EXPECT_NE(b.get("ADC", 0x00) & 1u << 8, 0u) << "ready";
  }
}

TEST(Rp2040Adc, ConversionsComeInThePeriodOfDivAndEightBitsAreTheHighest) {
  AdcBench b;
  b.set("ADC", 0x08, 1 | 2);
  b.set("ADC", 0x10, (479u << 8) | 128);  // 1 + INT + FRAC / 256 clocks
  b.set("ADC", 0x00, 1 | 3u << 12);
  b.set("ADC", 0x00, 1 | 3u << 12 | 1u << 3);
  for (int i = 0; i < 3; ++i) {
    b.run(480.5 / 96);
    EXPECT_EQ(b.get("ADC", 0x08) >> 16 & 15, static_cast<std::uint32_t>(i + 1));
  }
  EXPECT_EQ(b.get("ADC", 0x0C), 2000u >> 4);
}

TEST(Rp2040Adc, ItsFifoIsReadByDma) {
  AdcBench b;
  b.set("ADC", 0x08, 1 | 1u << 3 | 1u << 24);
  b.set("ADC", 0x00, 1 | 3u << 16);
  b.start(0, 0x4004C00C, kRam, 6, kOn | 1u << 2 | kWriteOn | request(36));
  b.set("ADC", 0x00, 1 | 3u << 16 | 1u << 3);
  b.run(6.5);
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(b.system.bus_read(kRam + 2 * i, 2), 500 * (i % 2 + 1)) << i;
}

TEST(Rp2040Watchdog, ItStandsWhileItIsNotEnabled) {
  Rp2040Bench b;
  b.set("WATCHDOG", 0x04, 2 * 100);
  b.system.run_for(125 * 500);
  b.set("WATCHDOG", 0x00 + kSet, 1u << 30);
  b.system.run_for(125 * 60);
  EXPECT_EQ(b.get("WATCHDOG", 0) & 0xFFFFFF, 2u * 40);
  b.set("WATCHDOG", 0x00 + kClear, 1u << 30);
  b.system.run_for(125 * 500);
  EXPECT_EQ(b.get("WATCHDOG", 0) & 0xFFFFFF, 2u * 40);
  EXPECT_TRUE(b.system.resets.empty());
  b.set("WATCHDOG", 0x00 + kSet, 1u << 30);
  b.system.run_for(125 * 41);
  EXPECT_EQ(b.system.resets.size(), 1u);
}

TEST(Rp2040Watchdog, ItsResetKeepsScratchAndSaysItsReason) {
  for (const bool forced : {false, true}) {
    Rp2040Bench b;
    for (std::uint32_t i = 0; i < 8; ++i) b.set("WATCHDOG", 0x0C + 4 * i, 0xC0DE0000 + i);
    b.set("PWM", 0x10, 7);
    b.set("WATCHDOG", 0x04, 2 * 10);
    b.set("WATCHDOG", 0x00 + kSet, forced ? 1u << 31 : 1u << 30);
    b.system.run_for(125 * 11);
    ASSERT_FALSE(b.system.resets.empty());
    b.system.cause = b.system.resets[0];
    b.chip.reset();
    EXPECT_EQ(b.get("WATCHDOG", 0x08), forced ? 2u : 1u);
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(b.get("WATCHDOG", 0x0C + 4 * i), 0xC0DE0000 + i);
    b.set("RESETS", kClear, 1u << 14);
    EXPECT_EQ(b.get("PWM", 0x10), 0xFFFFu);
    b.system.cause = "power-on";
    b.chip.reset();
    EXPECT_EQ(b.get("WATCHDOG", 0x0C), 0u);
  }
}

}  // namespace
}  // namespace omnihil::mcu
