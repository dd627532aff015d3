// Dual and triple modes: order of results, instants of sampling, what the common data register gives.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kRam = 0x20000000;

// Three converters of an F4, input n of ADC n at n tenths of the reference.
struct F4Bench : ChipBench {
  F4Bench() : ChipBench("stm32f407") {
    for (unsigned n = 1; n <= 3; ++n) {
      const std::string name = "ADC" + std::to_string(n);
      chip.find<Adc>(name)->set_source(n, [this, n](std::int64_t at_ns) {
        sampled.emplace_back(n, at_ns);
        return 0.33 * n;
      });
      set(name, 0x34, n);
      set(name, 0x08, 1);
    }
  }
  static std::uint32_t code(unsigned n) { return static_cast<std::uint32_t>(0.1 * n * 4096 + 0.5); }
  void start() { set("ADC1", 0x08, get("ADC1", 0x08) | 1u << 30); }
  // Half-words or words from the common data register to memory by DMA2 stream 0 channel 0.
  void dma(unsigned items, unsigned bytes) {
    const unsigned size = bytes == 4 ? 2 : 1;
    set("DMA2", 0x14, items);
    set("DMA2", 0x18, base("ADC") + 0x08);
    set("DMA2", 0x1C, kRam);
    set("DMA2", 0x10, size << 13 | size << 11 | 1u << 10 | 1);
  }
  std::vector<std::pair<unsigned, std::int64_t>> sampled;
};

TEST(AdcTogether, ThreeConvertAtOnceAndEachKeepsItsOwnResult) {
  F4Bench b;
  b.set("ADC", 0x04, 0b10110);
  b.start();
  b.system.run_for(2 * (3 + 12));
  ASSERT_EQ(b.sampled.size(), 3u);
  for (unsigned n = 1; n <= 3; ++n) {
    EXPECT_EQ(b.sampled[n - 1].second, b.system.to_ns(2 * 3)) << n;
    EXPECT_EQ(b.get("ADC" + std::to_string(n), 0x4C), F4Bench::code(n));
  }
  EXPECT_EQ(b.get("ADC", 0x08), F4Bench::code(2) << 16 | F4Bench::code(1));
}

TEST(AdcTogether, DualLeavesTheThirdAlone) {
  F4Bench b;
  b.set("ADC", 0x04, 0b00110);
  b.start();
  b.system.run_for(100);
  EXPECT_EQ(b.sampled.size(), 2u);
  EXPECT_EQ(b.get("ADC3", 0x00) & 2, 0u);
}

TEST(AdcTogether, IndependentConvertersDoNotStartEachOther) {
  F4Bench b;
  b.start();
  b.system.run_for(100);
  EXPECT_EQ(b.sampled.size(), 1u);
}

// DMA mode 1: ADC1, ADC2, ADC3, ADC1, … as half-words.
TEST(AdcTogether, DmaModeOneGivesHalfWordsInTheOrderOfTheConverters) {
  F4Bench b;
  b.dma(6, 2);
  b.set("ADC", 0x04, 0b10110 | 1u << 14 | 1u << 13);
  b.set("ADC1", 0x08, 1 | 1u << 1);  // continuous: the slaves follow the master's
  b.start();
  b.system.run_for(2 * 2 * 15 + 2);
  for (unsigned i = 0; i < 6; ++i)
    EXPECT_EQ(b.system.bus_read(kRam + 2 * i, 2), F4Bench::code(i % 3 + 1)) << i;
}

// DMA mode 2: ADC2 | ADC1, ADC1 | ADC3, ADC3 | ADC2 as words (RM0090 §13.9.3).
TEST(AdcTogether, DmaModeTwoGivesPairs) {
  F4Bench b;
  b.dma(3, 4);
  b.set("ADC", 0x04, 0b10110 | 2u << 14 | 1u << 13);
  b.set("ADC1", 0x08, 1 | 1u << 1);
  b.start();
  b.system.run_for(2 * 2 * 15 + 2);
  const auto pair = [](unsigned second, unsigned first) {
    return F4Bench::code(second) << 16 | F4Bench::code(first);
  };
  EXPECT_EQ(b.system.bus_read(kRam, 4), pair(2, 1));
  EXPECT_EQ(b.system.bus_read(kRam + 4, 4), pair(1, 3));
  EXPECT_EQ(b.system.bus_read(kRam + 8, 4), pair(3, 2));
}

// The k-th begins k times the delay later; never two sample at a time.
TEST(AdcTogether, InterleavedConvertersBeginOneAfterTheOther) {
  for (const auto& [delay_bits, delay_clocks] : {std::pair{0u, 5.0}, {4u, 9.0}}) {
    F4Bench b;
    b.set("ADC", 0x04, 0b10111 | delay_bits << 8);
    b.start();
    b.system.run_for(200);
    ASSERT_EQ(b.sampled.size(), 3u);
    for (unsigned k = 0; k < 3; ++k) {
      EXPECT_EQ(b.sampled[k].first, k + 1);
      EXPECT_EQ(b.sampled[k].second, b.system.to_ns(static_cast<Cycles>(2 * (3 + k * delay_clocks)))) << k;
    }
  }
  F4Bench slow;
  slow.set("ADC1", 0x10, 2u << 3);  // channel 1: 28 clocks of sampling
  slow.set("ADC", 0x04, 0b10111);
  slow.start();
  slow.system.run_for(300);
  ASSERT_EQ(slow.sampled.size(), 3u);
  EXPECT_EQ(slow.sampled[0].second, slow.system.to_ns(2 * 28));
  EXPECT_EQ(slow.sampled[1].second, slow.system.to_ns(2 * (30 + 3)));
}

TEST(AdcTogether, AlternateTriggersGoRoundTheConverters) {
  F4Bench b;
  for (unsigned n = 1; n <= 3; ++n) b.set("ADC" + std::to_string(n), 0x38, n << 15);
  b.set("ADC", 0x04, 0b11001);
  for (unsigned k = 0; k < 4; ++k) {
    b.set("ADC1", 0x08, 1 | 1u << 22);
    b.system.run_for(100);
    ASSERT_EQ(b.sampled.size(), k + 1);
    EXPECT_EQ(b.sampled[k].first, k % 3 + 1);
  }
}

TEST(AdcTogether, InjectedOnesStartTogetherAndRegularOnesDoNot) {
  F4Bench b;
  for (unsigned n = 1; n <= 3; ++n) b.set("ADC" + std::to_string(n), 0x38, n << 15);
  b.set("ADC", 0x04, 0b10101);
  b.set("ADC1", 0x08, 1 | 1u << 22);
  b.system.run_for(100);
  ASSERT_EQ(b.sampled.size(), 3u);
  for (unsigned n = 1; n <= 3; ++n) EXPECT_EQ(b.get("ADC" + std::to_string(n), 0x3C), F4Bench::code(n));
  b.start();
  b.system.run_for(100);
  EXPECT_EQ(b.sampled.size(), 4u);
}

TEST(AdcTogether, ConvertersThatAreOffStayOut) {
  F4Bench b;
  b.set("ADC2", 0x08, 0);
  b.set("ADC", 0x04, 0b10110);
  b.start();
  b.system.run_for(100);
  EXPECT_EQ(b.sampled.size(), 2u);
}

TEST(AdcTogether, AModeThatIsReservedIsReported) {
  F4Bench b;
  b.set("ADC", 0x04, 0b01111);
  EXPECT_EQ(b.system.unmodelled.count("ADC: CCR: a MULTI that is reserved"), 1u);
}

// F3 and G4: the slave needs no ADSTART of its own, and the pair is a word.
TEST(AdcTogether, PairsOfG4ConvertOnTheMastersStart) {
  ChipBench b("stm32g474");
  for (unsigned n = 1; n <= 2; ++n) {
    const std::string name = "ADC" + std::to_string(n);
    b.chip.find<Adc>(name)->set_source(n, [n](std::int64_t) { return 0.33 * n; });
    b.switch_adc_on(name);
    b.set(name, 0x30, n << 6);
  }
  b.set("ADC12", 0x08, 0b00110 | 1u << 16);
  b.start_adc("ADC1");
  b.system.run_for(200);
  EXPECT_EQ(b.get("ADC12", 0x0C), F4Bench::code(2) << 16 | F4Bench::code(1));
  EXPECT_EQ(b.get("ADC2", 0x40), F4Bench::code(2));
}

}  // namespace
}  // namespace omnihil::mcu
