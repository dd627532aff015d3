// The H7's master DMA: requests, buffers, blocks, repetitions, lists, sizes of items, interrupts (RM0433 §14).
#include <gtest/gtest.h>

#include <string>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kSource = 0x24000000, kDestination = 0x24001000;
constexpr std::uint32_t kUp = 2u | 2u << 2;  // both addresses go up, by bytes; items of bytes
constexpr std::uint32_t kSoftware = 1u << 30;
constexpr std::uint32_t kBuffers = 0u << 28, kBlocks = 1u << 28, kRepeated = 2u << 28, kWhole = 3u << 28;
constexpr std::uint32_t kError = 1, kChannelDone = 2, kBlocksDone = 4, kBlockDone = 8, kBufferDone = 16;

std::uint32_t length(std::uint32_t bytes) { return (bytes - 1) << 18; }

struct MdmaTest : testing::Test {
  ChipBench b{"stm32h743"};
  void set(unsigned channel, std::uint32_t offset, std::uint32_t value) {
    b.set("MDMA", 0x40 * channel + offset, value);
  }
  std::uint32_t get(unsigned channel, std::uint32_t offset) { return b.get("MDMA", 0x40 * channel + offset); }
  void fill(std::uint32_t at, const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      b.system.bus_write(at + static_cast<std::uint32_t>(i), 1, static_cast<std::uint8_t>(text[i]));
  }
  std::string text(std::uint32_t at, std::size_t bytes) {
    std::string all;
    for (std::size_t i = 0; i < bytes; ++i) {
      const auto c = static_cast<char>(b.system.bus_read(at + static_cast<std::uint32_t>(i), 1));
      all += c == 0 ? '.' : c;
    }
    return all;
  }
  void program(unsigned channel, std::uint32_t tcr, std::uint32_t bndtr) {
    set(channel, 0x50, tcr);
    set(channel, 0x54, bndtr);
    set(channel, 0x58, kSource);
    set(channel, 0x5C, kDestination);
  }
  void enable(unsigned channel, std::uint32_t interrupts = 0) { set(channel, 0x4C, interrupts | 1); }
  void request(unsigned channel, std::uint32_t interrupts = 0) {
    set(channel, 0x4C, interrupts | 1u << 16 | 1);
  }
};

// "Each MDMA request triggers a buffer transfer": TLEN + 1 bytes.
TEST_F(MdmaTest, ASoftwareRequestMovesABuffer) {
  fill(kSource, "abcdefgh");
  program(3, kUp | kSoftware | kBuffers | length(3), 8);
  request(3);
  EXPECT_EQ(text(kDestination, 8), "abc.....");
  EXPECT_EQ(get(3, 0x40), kBufferDone);
  EXPECT_EQ(get(3, 0x54), 5u) << "bytes that are left";
  request(3);
  request(3);
  EXPECT_EQ(text(kDestination, 8), "abcdefgh");
  EXPECT_EQ(get(3, 0x40), kBufferDone | kBlockDone | kBlocksDone | kChannelDone);
  EXPECT_EQ(get(3, 0x4C) & 1u, 0u) << "off";
}

TEST_F(MdmaTest, ABlockIsMovedByOneRequestWhereSoChosen) {
  fill(kSource, "abcdefgh");
  program(0, kUp | kSoftware | kBlocks | length(3), 8);
  request(0);
  EXPECT_EQ(text(kDestination, 8), "abcdefgh");
  set(0, 0x44, 0x1F);
  EXPECT_EQ(get(0, 0x40), 0u);
}

// BRC repetitions; at each block's end SUV is added to the source, DUV taken off the destination.
TEST_F(MdmaTest, RepeatedBlocksMoveTheirAddresses) {
  fill(kSource, "ab..cd..ef..");
  program(1, kUp | kSoftware | kRepeated | length(2), 2u | 1u << 19 | 2u << 20);
  set(1, 0x5C, kDestination + 8);
  set(1, 0x60, 2u | 5u << 16);
  request(1);
  EXPECT_EQ(text(kDestination, 10), "..ef.cd.ab") << "8, then 8 + 2 - 5, then 5 + 2 - 5";
  EXPECT_EQ(get(1, 0x40) & kChannelDone, kChannelDone);
}

// Order of the words: CTCR, CBNDTR, CSAR, CDAR, CBRUR, CLAR, CTBR, one reserved, CMAR, CMDR.
TEST_F(MdmaTest, AListIsLoadedFromItsAddress) {
  fill(kSource, "abcdefgh");
  const std::uint32_t node = 0x24002000;
  const std::uint32_t words[] = {
      kUp | kSoftware | kWhole | length(4), 4, kSource + 4, kDestination + 6, 0, 0, 0, 0, 0, 0};
  for (std::size_t i = 0; i < 10; ++i)
    b.system.bus_write(node + 4 * static_cast<std::uint32_t>(i), 4, words[i]);
  for (const std::uint32_t trigger : {kRepeated, kWhole}) {
    b.system.bus_write(node, 4, kUp | kSoftware | trigger | length(4));
    fill(kDestination, std::string(10, '\0'));
    set(2, 0x44, 0x1F);
    program(2, kUp | kSoftware | trigger | length(2), 2);
    set(2, 0x64, node);
    request(2);
    if (trigger == kRepeated) {
      EXPECT_EQ(text(kDestination, 10), "ab........");
      EXPECT_EQ(get(2, 0x40) & kChannelDone, 0u) << "its next part waits";
      request(2);
    }
    EXPECT_EQ(text(kDestination, 10), "ab....efgh");
    EXPECT_EQ(get(2, 0x40) & kChannelDone, kChannelDone);
  }
}

TEST_F(MdmaTest, ItemsOfTwoSizesArePackedOrFilledUpWithZeros) {
  fill(kSource, "abcdefgh");
  const std::uint32_t to_words = 2u | 2u << 2 | 0u << 4 | 2u << 6 | 0u << 8 | 2u << 10;
  program(0, to_words | 1u << 25 | kSoftware | kBlocks | length(8), 8);
  request(0);
  EXPECT_EQ(text(kDestination, 8), "abcdefgh");
  program(0, to_words | kSoftware | kBlocks | length(8), 2);
  request(0);
  EXPECT_EQ(text(kDestination, 9), "a...b....");
}

// The line of DMA1's stream 0 is high with TCIF0; MDR written to MAR takes it away.
TEST_F(MdmaTest, AStreamsEndIsARequestThatTheMaskAcknowledges) {
  fill(kSource, "abcdefgh");
  program(5, kUp | kBuffers | length(4), 8);
  set(5, 0x68, 0);
  set(5, 0x70, b.base("DMA1") + 0x08);
  set(5, 0x74, 1u << 5);
  enable(5);
  EXPECT_EQ(text(kDestination, 8), "........");
  for (int stream = 0; stream < 2; ++stream) {  // memory to memory: of the second one another channel hears
    const std::uint32_t at = 0x10 + 24 * static_cast<std::uint32_t>(stream);
    b.set("DMA1", at + 4, 1);
    b.set("DMA1", at + 8, 0x24003000);
    b.set("DMA1", at + 12, 0x24003100);
    b.set("DMA1", at, 2u << 6 | 1);
    EXPECT_EQ(text(kDestination, 8), "abcd....") << stream;
  }
  EXPECT_EQ(b.get("DMA1", 0x00) >> 5 & 1u, 0u) << "acknowledged";
  EXPECT_EQ(b.get("DMA1", 0x00) >> 11 & 1u, 1u);
}

TEST_F(MdmaTest, InterruptsAreThoseOfTheEnabledFlags) {
  program(4, kUp | kSoftware | kBuffers | length(4), 8);
  request(4, 1u << 2);  // CTCIE
  EXPECT_FALSE(b.system.irq_high[122]);
  request(4, 1u << 2);
  EXPECT_TRUE(b.system.irq_high[122]);
  EXPECT_EQ(b.get("MDMA", 0), 1u << 4);
  set(4, 0x44, kChannelDone);
  EXPECT_FALSE(b.system.irq_high[122]);
  EXPECT_EQ(b.get("MDMA", 0), 0u);
}

TEST_F(MdmaTest, TheCoresMemoryIsReachedByItsOwnBusAlone) {
  fill(kSource, "abcd");
  for (const bool own : {false, true}) {
    program(6, kUp | kSoftware | kBlocks | length(4), 4);
    set(6, 0x5C, 0x20000100);
    set(6, 0x68, own ? 1u << 17 : 0u);
    set(6, 0x44, 0x1F);
    request(6);
    EXPECT_EQ(text(0x20000100, 4), own ? "abcd" : "....");
    EXPECT_EQ(get(6, 0x40) & kError, own ? 0u : kError);
    EXPECT_EQ(get(6, 0x48) >> 7 & 1u, own ? 0u : 1u) << "of a write";
  }
}

TEST_F(MdmaTest, RegistersAreProtectedWhileTheChannelIsOn) {
  program(7, kUp | kSoftware | kBuffers | length(4), 8);
  enable(7);
  set(7, 0x58, 0x30000000);
  EXPECT_EQ(get(7, 0x58), kSource);
  set(7, 0x4C, 0);
  EXPECT_EQ(get(7, 0x40), kChannelDone) << "stopped on the way";
  set(7, 0x58, 0x30000000);
  EXPECT_EQ(get(7, 0x58), 0x30000000u);
}

TEST_F(MdmaTest, ABlockOfNothingIsAnError) {
  program(8, kUp | kSoftware | kBlocks | length(4), 0);
  request(8);
  EXPECT_EQ(get(8, 0x40), kError);
  EXPECT_EQ(get(8, 0x48), 1u << 11);
}

}  // namespace
}  // namespace omnihil::mcu
