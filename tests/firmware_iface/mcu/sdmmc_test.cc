// A memory card on its host, driven as drivers do: F7's with FIFO and DMA controller, H7's with FIFO and a DMA of its own.
#include "firmware_iface/mcu/stm32/sdmmc.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/device.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

enum : std::uint32_t {
  kPower = 0,
  kClkcr = 4,
  kArg = 8,
  kCmd = 12,
  kResp = 20,
  kDtimer = 36,
  kDlen = 40,
  kDctrl = 44,
  kSta = 52,
  kIcr = 56,
  kMask = 60,
  kFifo = 128
};
constexpr std::uint32_t kCcrcfail = 1, kCtimeout = 4, kDtimeout = 8, kTxunderr = 16, kRxoverr = 32,
                        kCmdrend = 64, kCmdsent = 128, kDataend = 256, kDbckend = 1024, kHalfEmpty = 1u << 14,
                        kHalfFull = 1u << 15, kRxEmpty = 1u << 19;
enum Answer : unsigned { kNo, kShort, kLong };
constexpr std::uint32_t kBlocks = 2048;  // 1 MiB

// Byte i of block b.
std::uint8_t at_first(std::uint32_t b, std::uint32_t i) {
  return static_cast<std::uint8_t>(7 * b + 3 * i + i / 256);
}

struct CardBench : ChipBench {
  explicit CardBench(const char* name)
      : ChipBench(name), v2(std::string_view(name).starts_with("stm32h7")), host(chip.find<Sdmmc>("SDMMC1")) {
    bytes.resize(kBlocks * kCardBlockBytes);
    for (std::uint32_t b = 0; b < kBlocks; ++b) {
      for (std::uint32_t i = 0; i < kCardBlockBytes; ++i) bytes[b * kCardBlockBytes + i] = at_first(b, i);
    }
    DeviceWorld world;
    world.card = {nullptr, bytes};
    card = find_device("sd_card")->make(world);
    card->reset();
    host->connect(*card->sd());
    put(kPower, 3);
    put(kClkcr, v2 ? 2 : 1u << 8 | 2);
  }
  void put(std::uint32_t offset, std::uint32_t value) { set("SDMMC1", offset, value); }
  std::uint32_t now(std::uint32_t offset) { return get("SDMMC1", offset); }
  bool wait(std::uint32_t flags) {
    for (int i = 0; i < 4000 && (now(kSta) & flags) == 0; ++i) system.run_for(100);
    return (now(kSta) & flags) != 0;
  }
  // The flags that it ended with; they are cleared.
  std::uint32_t command(unsigned index, std::uint32_t argument, Answer answer, std::uint32_t more = 0) {
    put(kArg, argument);
    const std::uint32_t codes[] = {0, 1, 3};
    put(kCmd, index | codes[answer] << (v2 ? 8 : 6) | 1u << (v2 ? 12 : 10) | more);
    EXPECT_TRUE(wait(kCcrcfail | kCtimeout | kCmdrend | kCmdsent)) << index;
    const std::uint32_t ended = now(kSta) & (kCcrcfail | kCtimeout | kCmdrend | kCmdsent);
    put(kIcr, ended);
    return ended;
  }
  std::uint32_t answer() { return now(kResp); }
  // As in the specification's figure 4-2; leaves it selected with four lines.
  void identify() {
    EXPECT_EQ(command(0, 0, kNo), kCmdsent);
    EXPECT_EQ(command(8, 0x1AA, kShort), kCmdrend);
    EXPECT_EQ(answer(), 0x1AAu);
    EXPECT_EQ(command(55, 0, kShort), kCmdrend);
    EXPECT_EQ(command(41, 0x40FF8000, kShort), kCcrcfail) << "an answer without a CRC";
    EXPECT_EQ(answer() >> 30, 3u) << "powered up, of high capacity";
    EXPECT_EQ(command(2, 0, kLong), kCmdrend);
    EXPECT_EQ(command(3, 0, kShort), kCmdrend);
    rca = answer() & 0xFFFF0000u;
    EXPECT_EQ(command(9, rca, kLong), kCmdrend);
    for (unsigned i = 0; i < 4; ++i) csd[i] = now(kResp + 4 * i);
    EXPECT_EQ(command(7, rca, kShort), kCmdrend);
    EXPECT_EQ(command(55, rca, kShort), kCmdrend);
    EXPECT_EQ(command(6, 2, kShort), kCmdrend);
    EXPECT_EQ(command(16, 512, kShort), kCmdrend);
    put(kClkcr, v2 ? 1u << 14 | 1u << 17 : 1u << 8 | 1u << 11 | 1u << 14);  // four lines, flow control
  }
  unsigned state() {
    EXPECT_EQ(command(13, rca, kShort), kCmdrend);
    return answer() >> 9 & 15;
  }
  void expect(std::uint32_t length, bool read, std::uint32_t more = 0) {
    put(kDtimer, 10'000'000);
    put(kDlen, length);
    put(kDctrl, 9u << 4 | (read ? 2u : 0u) | 1u | more);
  }
  std::vector<std::uint8_t> drain(std::uint32_t length) {
    std::vector<std::uint8_t> got;
    for (int i = 0; i < 100'000 && got.size() < length; ++i) {
      if ((now(kSta) & kHalfFull) != 0 || ((now(kSta) & kDataend) != 0 && (now(kSta) & kRxEmpty) == 0)) {
        const std::uint32_t word = now(kFifo);
        for (unsigned b = 0; b < 4; ++b) got.push_back(static_cast<std::uint8_t>(word >> (8 * b)));
      } else {
        system.run_for(50);
      }
    }
    return got;
  }
  void fill(const std::vector<std::uint8_t>& all) {
    std::size_t at = 0;
    for (int i = 0; i < 100'000 && at < all.size(); ++i) {
      if ((now(kSta) & kHalfEmpty) == 0) {
        system.run_for(50);
        continue;
      }
      for (int w = 0; w < 8 && at < all.size(); ++w, at += 4)
        put(kFifo,
            all[at] | all[at + 1] << 8 | all[at + 2] << 16 | static_cast<std::uint32_t>(all[at + 3]) << 24);
    }
  }

  bool v2;
  Sdmmc* host;
  std::vector<std::uint8_t> bytes;
  std::unique_ptr<Device> card;
  std::uint32_t rca = 0, csd[4] = {};
};

std::vector<std::uint8_t> as_they_were(std::uint32_t from, std::uint32_t count) {
  std::vector<std::uint8_t> all;
  for (std::uint32_t b = from; b < from + count; ++b) {
    for (std::uint32_t i = 0; i < kCardBlockBytes; ++i) all.push_back(at_first(b, i));
  }
  return all;
}
std::vector<std::uint8_t> counting(std::size_t length, std::uint8_t from) {
  std::vector<std::uint8_t> all(length);
  std::iota(all.begin(), all.end(), from);
  return all;
}
class MemoryCard : public testing::TestWithParam<const char*> {};

TEST_P(MemoryCard, IsIdentifiedAndSaysItsSize) {
  CardBench b(GetParam());
  b.identify();
  EXPECT_EQ(b.csd[0] >> 30, 1u) << "version 2";
  const std::uint32_t size = (b.csd[1] & 0x3F) << 16 | b.csd[2] >> 16;
  EXPECT_EQ((size + 1) * 1024, kBlocks);
  EXPECT_EQ(b.state(), 4u) << "transfer";
}

// As ChibiOS does it: CMD55 to see what card it is, and again before ACMD41.
TEST_P(MemoryCard, AnUnknownApplicationCommandIsThePlainOne) {
  CardBench b(GetParam());
  b.command(0, 0, kNo);
  EXPECT_EQ(b.command(55, 0, kShort), kCmdrend);
  EXPECT_EQ(b.command(55, 0, kShort), kCmdrend);
  EXPECT_EQ(b.command(41, 0x40FF8000, kShort), kCcrcfail);
}

TEST_P(MemoryCard, WithoutACardEveryCommandTimesOutAndIsCounted) {
  ChipBench b(GetParam());
  const bool v2 = std::string_view(GetParam()).starts_with("stm32h7");
  b.set("SDMMC1", kPower, 3);
  b.set("SDMMC1", kClkcr, v2 ? 2 : 1u << 8);
  b.set("SDMMC1", kCmd, 8 | 1u << (v2 ? 8 : 6) | 1u << (v2 ? 12 : 10));
  b.system.run_for(10'000);
  EXPECT_EQ(b.get("SDMMC1", kSta) & (kCtimeout | kCmdrend), kCtimeout);
  EXPECT_EQ(b.chip.find<Sdmmc>("SDMMC1")->ledger().losses().size(), 1u);
}

TEST_P(MemoryCard, ABlockComesThroughTheFifo) {
  CardBench b(GetParam());
  b.identify();
  b.expect(512, true);
  EXPECT_EQ(b.command(17, 5, kShort), kCmdrend);
  EXPECT_EQ(b.drain(512), as_they_were(5, 1));
  EXPECT_NE(b.now(kSta) & kDataend, 0u);
  EXPECT_NE(b.now(kSta) & kDbckend, 0u);
  EXPECT_EQ(b.state(), 4u);
}

TEST_P(MemoryCard, ManyBlocksComeUntilTheyAreStopped) {
  CardBench b(GetParam());
  b.identify();
  b.expect(3 * 512, true);
  EXPECT_EQ(b.command(18, 100, kShort), kCmdrend);
  EXPECT_EQ(b.drain(3 * 512), as_they_were(100, 3));
  EXPECT_TRUE(b.wait(kDataend));
  EXPECT_EQ(b.state(), 5u) << "it would send on";
  EXPECT_EQ(b.command(12, 0, kShort), kCmdrend);
  EXPECT_EQ(b.state(), 4u);
}

TEST_P(MemoryCard, WhatIsWrittenIsReadAndTheImageStays) {
  CardBench b(GetParam());
  b.identify();
  const auto data = counting(2 * 512, 9);
  EXPECT_EQ(b.command(25, 7, kShort), kCmdrend);
  b.expect(2 * 512, false);
  b.fill(data);
  EXPECT_TRUE(b.wait(kDataend));
  EXPECT_EQ(b.now(kSta) & kTxunderr, 0u);
  EXPECT_EQ(b.command(12, 0, kShort), kCmdrend);
  EXPECT_EQ(b.state(), 7u) << "it programs";
  b.system.run_for_ns(600'000);
  EXPECT_EQ(b.state(), 4u);
  b.put(kIcr, 0x7FF);
  b.expect(2 * 512, true);
  EXPECT_EQ(b.command(18, 7, kShort), kCmdrend);
  EXPECT_EQ(b.drain(2 * 512), data);
  EXPECT_EQ(b.bytes[7 * 512], at_first(7, 0)) << "what it was made of is not touched";
  EXPECT_EQ(b.card->changed_blocks()->size(), 2u);
}

// Half of a block has come, then power fails: the block is what it was.
TEST_P(MemoryCard, ABlockIsNeverHalfWritten) {
  CardBench b(GetParam());
  b.identify();
  EXPECT_EQ(b.command(24, 3, kShort), kCmdrend);
  b.expect(512, false);
  b.fill(counting(256, 0));
  b.system.run_for(1'000'000);
  EXPECT_EQ(b.now(kSta) & kDataend, 0u);
  b.card->reset();
  EXPECT_TRUE(b.card->changed_blocks()->empty());
}

TEST_P(MemoryCard, WithoutFlowControlAnUnreadFifoRunsOver) {
  CardBench b(GetParam());
  b.identify();
  b.put(kClkcr, b.v2 ? 1u << 14 : 1u << 8 | 1u << 11);
  b.expect(512, true);
  EXPECT_EQ(b.command(17, 5, kShort), kCmdrend);
  b.system.run_for(200'000);
  EXPECT_EQ(b.now(kSta) & (kRxoverr | kDataend), kRxoverr);
}

TEST_P(MemoryCard, BeyondItsEndItSaysSoAndNoDataCome) {
  CardBench b(GetParam());
  b.identify();
  b.put(kDtimer, 2000);
  b.put(kDlen, 512);
  b.put(kDctrl, 9u << 4 | 3);
  EXPECT_EQ(b.command(17, kBlocks, kShort), kCmdrend);
  EXPECT_EQ(b.answer() >> 31, 1u);
  EXPECT_TRUE(b.wait(kDtimeout));
}

TEST_P(MemoryCard, ItsConfigurationRegisterSaysFourLines) {
  CardBench b(GetParam());
  b.identify();
  b.put(kDtimer, 10'000'000);
  b.put(kDlen, 8);
  b.put(kDctrl, 3u << 4 | 3);
  EXPECT_EQ(b.command(55, b.rca, kShort), kCmdrend);
  EXPECT_EQ(b.command(51, 0, kShort), kCmdrend);
  const auto scr = b.drain(8);
  EXPECT_EQ(scr[0] & 15, 2) << "version 2 or later";
  EXPECT_EQ(scr[1] & 5, 5) << "one line and four";
}

// Four lines at SDMMC_CK = kernel: 16 pieces of 64 clocks and 18 more, 100 us after the command.
TEST(MemoryCardTime, ABlockTakesItsClocks) {
  CardBench b("stm32h743");
  b.identify();
  b.expect(512, true);
  b.put(kArg, 5);
  b.put(kCmd, 17 | 1u << 8 | 1u << 12);
  while ((b.now(kSta) & kCmdrend) == 0) b.system.run_for(1);
  const std::int64_t answered_ns = b.system.to_ns(b.system.now());
  std::size_t got = 0;
  while ((b.now(kSta) & kDataend) == 0) {
    b.system.run_for(1);
    while ((b.now(kSta) & kRxEmpty) == 0) b.now(kFifo), ++got;
  }
  EXPECT_EQ(got, 128u);
  const double clock_ns = 1e9 / b.chip.context().clocks.bus_hz(Bus::kSdmmc);
  const double expected_ns = 100e3 + (512 * 8 / 4 + 18) * clock_ns;
  EXPECT_NEAR(static_cast<double>(b.system.to_ns(b.system.now()) - answered_ns), expected_ns, 5 * clock_ns);
}

TEST(MemoryCardDma, F7sControllerFillsAndEmptiesMemory) {
  CardBench b("stm32f767");
  b.identify();
  const auto stream = [&b](std::uint32_t direction) {  // stream 3 of DMA2, channel 4; words
    const std::uint32_t at = 0x10 + 24 * 3;
    b.set("DMA2", at, 0);
    b.set("DMA2", 0x08, 0xFFFFFFFF);
    b.set("DMA2", at + 4, 256);
    b.set("DMA2", at + 8, b.base("SDMMC1") + kFifo);
    b.set("DMA2", at + 12, 0x20001000);
    b.set("DMA2", at, 4u << 25 | 2u << 13 | 2u << 11 | 1u << 10 | direction << 6 | 1);
  };
  stream(0);
  b.expect(2 * 512, true, 8);
  EXPECT_EQ(b.command(18, 40, kShort), kCmdrend);
  EXPECT_TRUE(b.wait(kDataend));
  EXPECT_EQ(b.command(12, 0, kShort), kCmdrend);
  const auto was = as_they_were(40, 2);
  for (std::uint32_t i = 0; i < 1024; ++i) ASSERT_EQ(b.system.memory[0x20001000 + i], was[i]) << i;
  b.put(kIcr, 0x7FF);
  b.put(kDctrl, 0);
  for (std::uint32_t i = 0; i < 1024; ++i) b.system.memory[0x20001000 + i] = static_cast<std::uint8_t>(i + 1);
  EXPECT_EQ(b.command(25, 60, kShort), kCmdrend);
  stream(1);
  b.expect(2 * 512, false, 8);
  EXPECT_TRUE(b.wait(kDataend));
  ASSERT_EQ(b.card->changed_blocks()->size(), 2u);
  EXPECT_EQ(b.card->changed_blocks()->at(61)[3], static_cast<std::uint8_t>(512 + 3 + 1));
}

TEST(MemoryCardDma, H7sOwnMovesWordsOfMemoryAndItsInterruptEnds) {
  CardBench b("stm32h743");
  b.identify();
  b.put(kMask, kDataend);
  b.put(0x58, 0x24000400);
  b.put(0x50, 1);
  b.put(kDtimer, 10'000'000);
  b.put(kDlen, 2 * 512);
  b.put(kDctrl, 9u << 4 | 2);
  EXPECT_EQ(b.command(18, 40, kShort, 1u << 6), kCmdrend) << "the command begins the transfer";
  for (int i = 0; i < 1000 && !b.system.irq_high[49]; ++i) b.system.run_for(1000);
  EXPECT_TRUE(b.system.irq_high[49]);
  const auto was = as_they_were(40, 2);
  for (std::uint32_t i = 0; i < 1024; ++i) ASSERT_EQ(b.system.memory[0x24000400 + i], was[i]) << i;
  b.put(kIcr, 0x1FE00FFF);
  EXPECT_FALSE(b.system.irq_high[49]);
  EXPECT_EQ(b.command(12, 0, kShort, 1u << 7), kCmdrend);
  b.put(kDctrl, 9u << 4);
  EXPECT_EQ(b.command(25, 60, kShort, 1u << 6), kCmdrend);
  EXPECT_TRUE(b.wait(kDataend));
  ASSERT_EQ(b.card->changed_blocks()->size(), 2u);
  EXPECT_EQ(b.card->changed_blocks()->at(60)[1], at_first(40, 1));
}

INSTANTIATE_TEST_SUITE_P(Hosts, MemoryCard, testing::Values("stm32f767", "stm32h743"));

}  // namespace
}  // namespace omnihil::mcu
