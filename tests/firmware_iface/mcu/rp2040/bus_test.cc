// SPI and I2C masters of the RP2040 against §4.4 and §4.3 of its datasheet.
#include <gtest/gtest.h>

#include <vector>

#include "firmware_iface/mcu/stm32/i2c.h"
#include "firmware_iface/mcu/stm32/spi.h"
#include "tests/firmware_iface/mcu/rp2040/rp2040_bench.h"

namespace omnihil::mcu {
namespace {
enum : std::uint32_t {
  kCr0 = 0x00,
  kCr1 = 0x04,
  kDr = 0x08,
  kSr = 0x0C,
  kCpsr = 0x10,
  kImsc = 0x14,
  kRis = 0x18,
  kIcr = 0x20,
  kDmacr = 0x24
};
enum : std::uint32_t { kTfe = 1, kTnf = 2, kRne = 4, kRff = 8, kBsy = 16 };

// Answers each byte with its complement.
struct Complement : SpiDevice {
  void select(bool) override {}
  std::uint8_t exchange(std::uint8_t from_master) override { return static_cast<std::uint8_t>(~from_master); }
};

struct SpiBench : Rp2040Bench {
  explicit SpiBench(std::uint32_t bits = 8) : spi(*chip.find<Spi>("SPI0")) {
    spi.connect(device);
    spi.select(device, true);
    spi.watch_frames([this](const SpiFrame& frame) { frames.push_back(frame); });
    set("SPI0", kCr0, bits - 1);
    set("SPI0", kCpsr, 2);
    set("SPI0", kCr1, 2);
  }
  Complement device;
  Spi& spi;
  std::vector<SpiFrame> frames;
};

// A bit is CPSDVSR (1 + SCR) of clk_peri.
TEST(Rp2040Spi, AFrameTakesItsBitsAtTheRateOfItsDividers) {
  struct Row {
    std::uint32_t prescale, scr, bits;
  };
  for (const Row row : {Row{2, 0, 8}, {4, 30, 8}, {254, 255, 16}, {10, 3, 4}}) {
    SpiBench b(row.bits);
    b.set("SPI0", kCpsr, row.prescale);
    b.set("SPI0", kCr0, (row.bits - 1) | row.scr << 8);
    const Cycles begin = b.system.now(), frame = Cycles{row.bits} * row.prescale * (row.scr + 1);
    b.set("SPI0", kDr, 5);
    b.set("SPI0", kDr, 6);
    b.system.run_for(2 * frame - 1);
    EXPECT_NE(b.get("SPI0", kSr) & kBsy, 0u);
    b.system.run_for(1);
    EXPECT_EQ(b.get("SPI0", kSr) & kBsy, 0u);
    ASSERT_EQ(b.frames.size(), 2u);
    EXPECT_EQ(b.frames[1].end - begin, 2 * frame);
  }
}

TEST(Rp2040Spi, WhatComesBackIsReadInOrderAndSixteenBitsHighByteFirst) {
  SpiBench b(16);
  for (std::uint32_t i = 0; i < 3; ++i) b.set("SPI0", kDr, 0x1200 + i);
  b.system.run_for(3 * 32);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(b.get("SPI0", kDr), (~(0x1200 + i)) & 0xFFFF) << i;
  EXPECT_EQ(b.get("SPI0", kSr), static_cast<std::uint32_t>(kTfe | kTnf));
}

TEST(Rp2040Spi, ItsFifosAreEightDeepAndInterruptHalfWay) {
  SpiBench b;
  b.set("SPI0", kCr1, 0);
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_NE(b.get("SPI0", kSr) & kTnf, 0u) << i;
    EXPECT_EQ((b.get("SPI0", kRis) & 8) != 0, i <= 4) << i;
    b.set("SPI0", kDr, i);
  }
  EXPECT_EQ(b.get("SPI0", kSr), static_cast<std::uint32_t>(kBsy)) << "what waits to be sent keeps it busy";
  b.set("SPI0", kImsc, 4);
  b.set("SPI0", kCr1, 2);
  b.system.run_for(3 * 16);
  EXPECT_FALSE(b.system.irq_high[18]);
  b.system.run_for(16);
  EXPECT_TRUE(b.system.irq_high[18]) << "four received";
  b.get("SPI0", kDr);
  EXPECT_FALSE(b.system.irq_high[18]);
}

TEST(Rp2040Spi, TheNinthReceivedFrameIsLostAndItsOverrunLatched) {
  SpiBench b;
  for (std::uint32_t i = 0; i < 9; ++i) {
    b.set("SPI0", kDr, i);
    b.system.run_for(16);
    EXPECT_EQ(b.get("SPI0", kRis) & 1, i == 8 ? 1u : 0u) << i;
  }
  EXPECT_NE(b.get("SPI0", kSr) & kRff, 0u);
  b.set("SPI0", kIcr, 1);
  EXPECT_EQ(b.get("SPI0", kRis) & 1, 0u);
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(b.get("SPI0", kDr), 0xFF - i);
  EXPECT_EQ(b.get("SPI0", kSr) & kRne, 0u);
}

TEST(Rp2040Spi, DmaSendsAndReceivesABlock) {
  SpiBench b;
  for (std::uint32_t i = 0; i < 20; ++i) b.system.bus_write(0x20000000 + i, 1, i);
  b.set("SPI0", kDmacr, 3);
  const auto start = [&b](std::uint32_t at, std::uint32_t from, std::uint32_t to, std::uint32_t control) {
    b.set("DMA", at, from);
    b.set("DMA", at + 4, to);
    b.set("DMA", at + 8, 20);
    b.set("DMA", at + 12, control);
  };
  start(0x40, 0x4003C008, 0x20000100, 1 | 1u << 5 | 1u << 11 | 17u << 15);
  start(0x00, 0x20000000, 0x4003C008, 1 | 1u << 4 | 16u << 15);
  b.system.run_for(20 * 16);
  for (std::uint32_t i = 0; i < 20; ++i) EXPECT_EQ(b.system.bus_read(0x20000100 + i, 1), 0xFF - i) << i;
  EXPECT_EQ(b.get("DMA", 0x400), 3u);
}

enum : std::uint32_t {
  kCon = 0x00,
  kTar = 0x04,
  kData = 0x10,
  kHigh = 0x1C,
  kLow = 0x20,
  kMask = 0x30,
  kRaw = 0x34,
  kClearAbort = 0x54,
  kClearStop = 0x60,
  kEnable = 0x6C,
  kStatus = 0x70,
  kRxCount = 0x78,
  kSource = 0x80,
  kSpike = 0xA0
};
enum : std::uint32_t { kRead = 1u << 8, kStop = 1u << 9, kRestart = 1u << 10 };

// Registers that the first byte selects.
struct Registers : I2cDevice {
  explicit Registers(const FakeSystem& of) : system(of) {}
  std::uint8_t address() const override { return 0x36; }
  void start(bool read) override {
    starts.push_back(read);
    first = !read;
  }
  bool write(std::uint8_t byte) override {
    written.push_back(byte);
    at.push_back(system.now());
    if (first) place = byte;
    first = false;
    return written.size() <= takes;
  }
  std::uint8_t read() override { return static_cast<std::uint8_t>(0xA0 + place++); }
  const FakeSystem& system;
  std::vector<bool> starts;
  std::vector<std::uint8_t> written;
  std::vector<Cycles> at;
  std::size_t takes = 100;
  bool first = false;
  std::uint8_t place = 0;
};

struct I2cBench : Rp2040Bench {
  I2cBench() {
    chip.find<I2c>("I2C1")->connect(device);
    set("I2C1", kEnable, 0);
    set("I2C1", kCon, 0x165);  // master, fast, restarts, TX_EMPTY at the end of a byte
    set("I2C1", kHigh, 120);
    set("I2C1", kLow, 180);
    set("I2C1", kSpike, 11);
    set("I2C1", kTar, 0x36);
    set("I2C1", kEnable, 1);
  }
  Registers device{system};
};

TEST(Rp2040I2c, ARegisterIsWrittenAndReadBehindARestart) {
  I2cBench b;
  b.set("I2C1", kData, 7);
  b.set("I2C1", kData, kRead | kRestart);
  b.set("I2C1", kData, kRead | kStop);
  b.system.run_for(60'000);
  EXPECT_EQ(b.device.starts, (std::vector<bool>{false, true}));
  EXPECT_EQ(b.device.written, (std::vector<std::uint8_t>{7}));
  EXPECT_EQ(b.get("I2C1", kRxCount), 2u);
  EXPECT_EQ(b.get("I2C1", kData), 0xA7u);
  EXPECT_EQ(b.get("I2C1", kData), 0xA8u);
  EXPECT_NE(b.get("I2C1", kRaw) & 1u << 9, 0u) << "STOP_DET";
  b.get("I2C1", kClearStop);
  EXPECT_EQ(b.get("I2C1", kRaw) & 1u << 9, 0u);
  EXPECT_EQ(b.get("I2C1", kStatus) & 0x21, 0u);
}

// Nine clocks a byte; high for HCNT + SPKLEN + 7 cycles, low for LCNT + 1 (§4.3.14).
TEST(Rp2040I2c, AByteTakesNineClocksOfItsCounts) {
  I2cBench b;
  for (std::uint32_t i = 0; i < 4; ++i) b.set("I2C1", kData, i | (i == 3 ? kStop : 0u));
  b.system.run_for(60'000);
  ASSERT_EQ(b.device.at.size(), 4u);
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_EQ(b.device.at[i] - b.device.at[i - 1], 9u * (120 + 11 + 7 + 180 + 1));
}

TEST(Rp2040I2c, NobodyAtTheAddressAbortsEmptiesAndStops) {
  I2cBench b;
  b.set("I2C1", kEnable, 0);
  b.set("I2C1", kTar, 0x37);
  b.set("I2C1", kEnable, 1);
  b.set("I2C1", kMask, 1u << 6);
  for (std::uint32_t i = 0; i < 3; ++i) b.set("I2C1", kData, i);
  b.system.run_for(10'000);
  EXPECT_TRUE(b.system.irq_high[24]);
  EXPECT_EQ(b.get("I2C1", kSource) & 0xFFFF, 1u) << "ABRT_7B_ADDR_NOACK";
  EXPECT_NE(b.get("I2C1", kStatus) & 4, 0u) << "emptied";
  EXPECT_NE(b.get("I2C1", kRaw) & 1u << 9, 0u) << "stopped";
  b.get("I2C1", kClearAbort);
  EXPECT_FALSE(b.system.irq_high[24]);
  EXPECT_EQ(b.get("I2C1", kSource), 0u);
}

TEST(Rp2040I2c, AByteThatIsNotAcknowledgedAborts) {
  I2cBench b;
  b.device.takes = 1;
  for (std::uint32_t i = 0; i < 3; ++i) b.set("I2C1", kData, i | (i == 2 ? kStop : 0u));
  b.system.run_for(60'000);
  EXPECT_EQ(b.device.written.size(), 2u);
  EXPECT_EQ(b.get("I2C1", kSource) & 0xFFFF, 8u) << "ABRT_TXDATA_NOACK";
}

}  // namespace
}  // namespace omnihil::mcu
