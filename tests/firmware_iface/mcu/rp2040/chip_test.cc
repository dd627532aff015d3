// Blocks of the RP2040 against the formulas of its datasheet.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "firmware_iface/mcu/rp2040/boot_rom.h"
#include "firmware_iface/mcu/rp2040/pio_machine.h"
#include "firmware_iface/mcu/rp2040/rom_floats.h"
#include "firmware_iface/mcu/rp2040/sio.h"
#include "firmware_iface/mcu/stm32/adc/adc.h"
#include "tests/firmware_iface/mcu/rp2040/rp2040_bench.h"

namespace omnihil::mcu {
namespace {
TEST(Rp2040, ClocksComeFromTheContentsOfTheRegisters) {
  Rp2040Bench b;
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 12e6 * 125 / (6 * 2));
  EXPECT_NE(b.get("PLL_SYS", 0) & 1u << 31, 0u);
  b.set("CLOCKS", 0x40, 2u << 8);  // clk_sys by 2
  EXPECT_DOUBLE_EQ(b.system.core_hz(), 62.5e6);
  b.set("CLOCKS", 0x94, 9);  // the frequency counter on clk_sys: kHz and 5 bits of fraction
  EXPECT_EQ(b.get("CLOCKS", 0x9C), 62500u << 5);
  EXPECT_TRUE(b.system.unmodelled.empty());
}

TEST(Rp2040, AliasesSetClearAndFlipBits) {
  Rp2040Bench b;
  b.set("PWM", 0x10, 0x0F0F);
  b.set("PWM", 0x10 + kSet, 0x00F0);
  EXPECT_EQ(b.get("PWM", 0x10), 0x0FFFu);
  b.set("PWM", 0x10 + kClear, 0x000F);
  EXPECT_EQ(b.get("PWM", 0x10), 0x0FF0u);
  b.set("PWM", 0x10 + kFlip, 0xFFFF);
  EXPECT_EQ(b.get("PWM", 0x10), 0xF00Fu);
}

TEST(Rp2040, ABlockHeldInResetIgnoresWritesAndIsSaid) {
  Rp2040Bench b;
  b.set("RESETS", kSet, 1u << 14);
  b.set("PWM", 0x10, 7);
  EXPECT_EQ(b.get("RESETS", 8) >> 14 & 1, 0u);
  b.set("RESETS", kClear, 1u << 14);
  EXPECT_EQ(b.get("PWM", 0x10), 0xFFFFu);
  ASSERT_EQ(b.system.unmodelled.size(), 1u);
  EXPECT_NE(b.system.unmodelled.begin()->first.find("PWM"), std::string::npos);
}

TEST(Rp2040, TimerCountsMicrosecondsAndItsAlarmRaisesItsInterruptAtTheInstant) {
  Rp2040Bench b;
  const std::uint32_t begin = b.get("TIMER", 0x28);
  b.system.run_for(125 * 1000);
  EXPECT_EQ(b.get("TIMER", 0x28) - begin, 1000u);
  b.set("TIMER", 0x38, 1);
  b.set("TIMER", 0x10, b.get("TIMER", 0x28) + 50);
  b.system.run_for(125 * 49 - 1);
  EXPECT_FALSE(b.system.irq_high[0]);
  b.system.run_for(125 + 1);
  EXPECT_TRUE(b.system.irq_high[0]);
  b.set("TIMER", 0x34, 1);
  EXPECT_FALSE(b.system.irq_high[0]);
}

TEST(Rp2040, WatchdogFallsByTwoATickAndResetsTheChip) {
  Rp2040Bench b;
  b.set("WATCHDOG", 4, 2 * 100);
  b.set("WATCHDOG", 0 + kSet, 1u << 30);
  b.system.run_for(125 * 40);
  EXPECT_EQ(b.get("WATCHDOG", 0) & 0xFFFFFF, 2u * 60);
  b.set("WATCHDOG", 0x0C, 0x1234);
  b.set("WATCHDOG", 4, 2 * 100);  // fed
  b.system.run_for(125 * 99);
  EXPECT_TRUE(b.system.resets.empty());
  b.system.run_for(125 * 2);
  ASSERT_EQ(b.system.resets.size(), 1u);
}

// f = clk_sys / ((TOP + 1) (PH_CORRECT + 1) (INT + FRAC / 16)), §4.5.2.6.
TEST(Rp2040, PwmPeriodAndDutyAreThoseOfTheDatasheet) {
  Rp2040Bench b;
  PwmOutputs& slice = b.slice("PWM3");
  b.set("IO_BANK0", 8 * 6 + 4, IoBank::kPwm);
  b.set("PWM", 0x3C + 0x10, 999);
  b.set("PWM", 0x3C + 0x04, 4u << 4 | 8);
  b.set("PWM", 0x3C + 0x0C, 250);
  b.set("PWM", 0x3C, 1);
  EXPECT_DOUBLE_EQ(slice.period_s(), 1000 * 4.5 / 125e6);
  EXPECT_EQ(slice.pin(0, false), (TimerPin{TimerPin::Drive::kPwm, 0.25}));
  EXPECT_EQ(slice.pin(1, false).drive, TimerPin::Drive::kOff) << "GP7 is nobody's";
  b.set("PWM", 0x3C, 3);
  EXPECT_DOUBLE_EQ(slice.period_s(), 2 * 1000 * 4.5 / 125e6);
}

TEST(Rp2040, PwmCompareValuesAreTakenAtTheWrapWhichRaisesItsInterrupt) {
  Rp2040Bench b;
  PwmOutputs& slice = b.slice("PWM0");
  b.set("IO_BANK0", 4, IoBank::kPwm);
  b.set("PWM", 0x10, 99);
  b.set("PWM", 0x0C, 10);
  b.set("PWM", 0xA8, 1);
  b.set("PWM", 0x00, 1);
  b.system.run_for(50);
  b.set("PWM", 0x0C, 90);
  b.system.run_for(49);
  EXPECT_DOUBLE_EQ(slice.pin(0, false).high_ratio, 0.1);
  EXPECT_FALSE(b.system.irq_high[4]);
  b.system.run_for(2);
  EXPECT_DOUBLE_EQ(slice.pin(0, false).high_ratio, 0.9);
  EXPECT_TRUE(b.system.irq_high[4]);
  b.system.run_for(9);
  EXPECT_EQ(b.get("PWM", 0x08), 10u);
}

TEST(Rp2040, PwmCountsTheEdgesOfItsSecondPin) {
  Rp2040Bench b;
  b.set("IO_BANK0", 8 * 5 + 4, IoBank::kPwm);  // GP5: PWM2's B
  b.set("PWM", 0x28 + 0x04, 1u << 4);
  b.set("PWM", 0x28, 1u | 2u << 4);
  for (int i = 0; i < 7; ++i) {
    b.chip.port(PinBank::kGp)->drive(5, true);
    b.chip.port(PinBank::kGp)->drive(5, false);
  }
  EXPECT_EQ(b.get("PWM", 0x28 + 0x08), 7u);
}

TEST(Rp2040, UartDividesClkPeriAndAFrameTakesItsTenBits) {
  Rp2040Bench b;
  auto& port = *b.chip.find<SerialPort>("UART0");
  std::string sent;
  Cycles end = 0;
  port.on_transmit([&](std::uint8_t byte, Cycles at) { sent += static_cast<char>(byte), end = at; });
  b.set("UART0", 0x24, 67);
  b.set("UART0", 0x28, 52);
  b.set("UART0", 0x2C, 0x70);
  b.set("UART0", 0x30, 0x301);
  EXPECT_NEAR(port.baud(), 125e6 / (16 * (67 + 52 / 64.0)), 1e-6);
  const Cycles begin = b.system.now();
  b.set("UART0", 0x00, 'a');
  b.set("UART0", 0x00, 'b');
  b.system.run_for(40'000);
  EXPECT_EQ(sent, "ab");
  EXPECT_NEAR(static_cast<double>(end - begin), 20 * 16 * (67 + 52 / 64.0), 2.0);
  const std::uint8_t byte = 'x';
  port.feed({&byte, 1}, b.system.to_ns(b.system.now()));
  b.system.run_for(20'000);
  EXPECT_EQ(b.get("UART0", 0x18) & 0x10, 0u);
  EXPECT_EQ(b.get("UART0", 0x00), static_cast<std::uint32_t>('x'));
}

TEST(Rp2040, PinsInterruptAtEdgesAndShowLevels) {
  Rp2040Bench b;
  PinBank& pins = *b.chip.port(PinBank::kGp);
  b.set("IO_BANK0", 0x100 + 4, 0x4u << 24);  // falling edges of GP14
  pins.drive(14, true);
  EXPECT_FALSE(b.system.irq_high[13]);
  pins.drive(14, false);
  EXPECT_TRUE(b.system.irq_high[13]);
  EXPECT_EQ(b.get("IO_BANK0", 0xF4) >> 24 & 15, 0xDu) << "both edges, low";
  b.set("IO_BANK0", 0xF4, 0xFu << 24);
  EXPECT_FALSE(b.system.irq_high[13]);
}

TEST(Rp2040, SioDrivesItsPinsAloneAndSeesThem) {
  Rp2040Bench b;
  PinBank& pins = *b.chip.port(PinBank::kGp);
  b.set("SIO", 0x24, 3u << 10);
  b.set("SIO", 0x14, 3u << 10);
  EXPECT_FALSE(pins.output(10) && pins.mode(10) == PinMode::kOutput) << "given to nobody";
  b.set("IO_BANK0", 8 * 10 + 4, IoBank::kSio);
  EXPECT_EQ(pins.mode(10), PinMode::kOutput);
  EXPECT_TRUE(pins.level(10));
  EXPECT_EQ(b.get("SIO", 0x04) >> 10 & 3, 1u);
  b.set("SIO", 0x1C, 1u << 10);
  EXPECT_FALSE(pins.level(10));
}

TEST(Rp2040, TheDividerRoundsTowardsZeroAndDividesByZeroAsTheChip) {
  EXPECT_EQ(divide(100, 7, false).quotient, 14u);
  EXPECT_EQ(divide(static_cast<std::uint32_t>(-100), 7, true).quotient, static_cast<std::uint32_t>(-14));
  EXPECT_EQ(divide(static_cast<std::uint32_t>(-100), 7, true).remainder, static_cast<std::uint32_t>(-2));
  EXPECT_EQ(divide(5, 0, false).quotient, 0xFFFFFFFFu);
  EXPECT_EQ(divide(static_cast<std::uint32_t>(-5), 0, true).quotient, 1u);
  EXPECT_EQ(divide(0x80000000u, 0xFFFFFFFFu, true).quotient, 0x80000000u);
  Rp2040Bench b;
  b.set("SIO", 0x68, static_cast<std::uint32_t>(-100));
  b.set("SIO", 0x6C, 7);
  EXPECT_EQ(b.get("SIO", 0x78), 3u);
  EXPECT_EQ(b.get("SIO", 0x74), static_cast<std::uint32_t>(-2));
  EXPECT_EQ(b.get("SIO", 0x70), static_cast<std::uint32_t>(-14));
  EXPECT_EQ(b.get("SIO", 0x78), 1u);
}

TEST(Rp2040, ASpinlockIsTakenOnceUntilItIsFreed) {
  Rp2040Bench b;
  EXPECT_EQ(b.get("SIO", 0x100 + 4 * 5), 1u << 5);
  EXPECT_EQ(b.get("SIO", 0x100 + 4 * 5), 0u);
  b.set("SIO", 0x100 + 4 * 5, 1);
  EXPECT_EQ(b.get("SIO", 0x100 + 4 * 5), 1u << 5);
}

TEST(Rp2040, LaunchingCoreOneIsAnsweredAndSaid) {
  Rp2040Bench b;
  for (const std::uint32_t word : {0u, 0u, 1u, 0x10000100u, 0x20040000u, 0x10000201u}) {
    b.set("SIO", 0x54, word);
    EXPECT_EQ(b.get("SIO", 0x58), word);
  }
  ASSERT_EQ(b.system.unmodelled.size(), 1u);
  EXPECT_NE(b.system.unmodelled.begin()->first.find("core 1 was launched at 0x10000200"), std::string::npos);
}

TEST(Rp2040, AdcTakesItsInputsInTurnIntoItsFifo) {
  Rp2040Bench b;
  b.set("CLOCKS", 0x60, 1u << 11 | 3u << 5);  // clk_adc: the crystal
  Adc& adc = *b.chip.find<Adc>("ADC");
  adc.set_voltage(0, 3.3 * 1000 / 4096);
  adc.set_voltage(2, 3.3 * 2000 / 4096);
  b.set("ADC", 0x08, 1);
  b.set("ADC", 0x00, 1u | 5u << 16);
  b.set("ADC", 0x00, 1u | 5u << 16 | 1u << 3);
  b.system.run_for(static_cast<Cycles>(3.5 * 96 * 125 / 12));
  EXPECT_EQ(b.get("ADC", 0x08) >> 16 & 15, 3u);
  EXPECT_EQ(b.get("ADC", 0x0C), 1000u);
  EXPECT_EQ(b.get("ADC", 0x0C), 2000u);
  EXPECT_EQ(b.get("ADC", 0x0C), 1000u);
}

TEST(Rp2040, DmaMovesWordsAndStartsTheChannelThatItIsChainedTo) {
  Rp2040Bench b;
  for (std::uint32_t i = 0; i < 4; ++i) b.system.bus_write(0x20000000 + 4 * i, 4, 100 + i);
  const std::uint32_t control = 1u | 2u << 2 | 1u << 4 | 1u << 5 | 0x3Fu << 15;
  b.set("DMA", 0x40, 0x20000100);  // channel 1 copies what channel 0 has copied
  b.set("DMA", 0x44, 0x20000200);
  b.set("DMA", 0x48, 4);
  b.set("DMA", 0x50, control | 1u << 11);
  b.set("DMA", 0x404, 2);
  b.set("DMA", 0x00, 0x20000000);
  b.set("DMA", 0x04, 0x20000100);
  b.set("DMA", 0x08, 4);
  b.set("DMA", 0x0C, control | 1u << 11);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(b.system.bus_read(0x20000200 + 4 * i, 4), 100 + i);
  EXPECT_EQ(b.get("DMA", 0x400), 3u);
  EXPECT_TRUE(b.system.irq_high[11]);
}

TEST(Rp2040, PioBlinksAPinInTheTimeOfItsInstructions) {
  Rp2040Bench b;
  b.set("IO_BANK0", 8 * 7 + 4, IoBank::kPio0);
  b.set("PIO0", 0xC8, 2u << 16);            // every second cycle
  b.set("PIO0", 0xDC, 7u << 5 | 1u << 26);  // SET: GP7
  b.set("PIO0", 0xD8, 0xE081);              // set pindirs 1
  b.set("PIO0", 0xD8, 0x0000);              // jmp 0
  b.set("PIO0", 0x48, 0xE001 | 9u << 8);    // set pins 1 [9]
  b.set("PIO0", 0x4C, 0xE000 | 4u << 8);    // set pins 0 [4]
  b.set("PIO0", 0xCC, 1u << 12);            // wraps from 1 to 0
  std::vector<std::pair<Cycles, bool>> edges;
  b.chip.port(PinBank::kGp)->on_output(7, [&](bool level) { edges.emplace_back(b.system.now(), level); });
  b.set("PIO0", 0x00, 1);
  b.system.run_for(200);
  ASSERT_GT(edges.size(), 4u);
  for (std::size_t i = 1; i < edges.size(); ++i)
    EXPECT_EQ(edges[i].first - edges[i - 1].first, edges[i].second ? 2u * 5 : 2u * 10) << i;
}

// The program of tests/firmware_iface/mcu/images/wheels_rp2040.c: the lines' levels at each change.
TEST(Rp2040, PioThatSleepsBetweenChangesOfItsPinsMissesNone) {
  Rp2040Bench b;
  PinBank& pins = *b.chip.port(PinBank::kGp);
  constexpr std::uint16_t kProgram[] = {0x4002, 0xA026, 0xA0C3, 0x00A5, 0x0000, 0xA041, 0xA0C1, 0x8020};
  for (std::uint32_t i = 0; i < 8; ++i) b.set("PIO0", 0x48 + 4 * i, kProgram[i]);
  b.set("PIO0", 0xCC, 7u << 12);
  b.set("PIO0", 0xD0, 1u << 31);
  b.set("PIO0", 0xDC, 18u << 15);
  b.set("PIO0", 0x00, 1);
  const std::uint32_t levels[] = {1, 3, 2, 0, 2, 3};
  for (const std::uint32_t level : levels) {
    b.system.run_for(1000);
    for (unsigned i = 0; i < 2; ++i) pins.drive(18 + i, (level >> i & 1u) != 0);
  }
  b.system.run_for(1000);
  for (const std::uint32_t level : levels) {
    EXPECT_EQ(b.get("PIO0", 0x04) & 0x100, 0u);
    EXPECT_EQ(b.get("PIO0", 0x20), level);
  }
  EXPECT_NE(b.get("PIO0", 0x04) & 0x100, 0u) << "no more";
}

TEST(Rp2040, FloatsOfTheBootRomAreTheHostsAndTheirIntegersGoDown) {
  RomWords words{std::bit_cast<std::uint32_t>(1.5f), std::bit_cast<std::uint32_t>(2.25f), 0, 0};
  EXPECT_EQ(rom_float(0, words).words, 1u);
  EXPECT_EQ(std::bit_cast<float>(words[0]), 3.75f);
  words = {std::bit_cast<std::uint32_t>(-1.5f), 0, 0, 0};
  rom_float(7, words);
  EXPECT_EQ(static_cast<std::int32_t>(words[0]), -2);
  words = {std::bit_cast<std::uint32_t>(1e20f), 0, 0, 0};
  rom_float(7, words);
  EXPECT_EQ(words[0], 0x7FFFFFFFu);
  const auto third = std::bit_cast<std::uint64_t>(1.0 / 3.0);
  words = {static_cast<std::uint32_t>(third), static_cast<std::uint32_t>(third >> 32), 0, 0};
  EXPECT_EQ(rom_double(31, words).words, 1u);
  EXPECT_EQ(std::bit_cast<float>(words[0]), static_cast<float>(1.0 / 3.0));
}

TEST(Rp2040, TheChecksumOfASecondStageIsTheCrcOfItsName) {
  const std::string check = "123456789";  // CRC-32/MPEG-2: 0x0376E6E7
  EXPECT_EQ(boot_checksum({reinterpret_cast<const std::uint8_t*>(check.data()), check.size()}), 0x0376E6E7u);
}

}  // namespace
}  // namespace omnihil::mcu
