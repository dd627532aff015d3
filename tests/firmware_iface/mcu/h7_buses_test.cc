// SPI, FDCAN and the serial FIFOs of H7, driven as drivers do (RM0433).
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/spi.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

// Answers what it was sent before, and keeps all of it.
struct Echo final : SpiDevice {
  void select(bool) override {}
  std::uint8_t exchange(std::uint8_t out) override {
    seen.push_back(out);
    const std::uint8_t answer = last;
    last = out;
    return answer;
  }
  std::vector<std::uint8_t> seen;
  std::uint8_t last = 0xEE;
};

enum : std::uint32_t {
  kCr1 = 0,
  kCr2 = 4,
  kCfg1 = 8,
  kCfg2 = 12,
  kIer = 16,
  kSr = 20,
  kIfcr = 24,
  kTxdr = 32,
  kRxdr = 48
};
constexpr std::uint32_t kEot = 1u << 3, kTxtf = 1u << 4, kSpe = 1, kCstart = 1u << 9;

struct H7Spi : testing::Test {
  H7Spi() {
    spi->connect(echo);
    spi->select(echo, true);
    b.set("SPI1", kCfg2, 1u << 22 | 1u << 26);
  }
  void begin(unsigned bits, unsigned frames, unsigned prescaler = 0) {
    b.set("SPI1", kCr1, 0);
    b.set("SPI1", kCfg1, prescaler << 28 | (bits - 1));
    b.set("SPI1", kCr2, frames);
    b.set("SPI1", kCr1, kSpe);
    b.set("SPI1", kCr1, kSpe | kCstart);
  }
  std::uint32_t status() { return b.get("SPI1", kSr); }
  ChipBench b{"stm32h743"};
  Spi* spi = b.chip.find<Spi>("SPI1");
  Echo echo;
};

TEST_F(H7Spi, ATransferOfItsSizeEndsWithEotAndStopsItself) {
  begin(8, 3);
  for (const std::uint8_t c : {1, 2, 3}) {
    EXPECT_NE(status() & 2u, 0u) << "room for a frame";
    b.system.bus_write(b.base("SPI1") + kTxdr, 1, c);
  }
  EXPECT_EQ(status() & (2u | kTxtf), kTxtf) << "all are written, no room is offered";
  b.system.run_for(1000);
  EXPECT_EQ(status() & kEot, kEot);
  EXPECT_EQ(b.get("SPI1", kCr1) & kCstart, 0u);
  EXPECT_EQ(echo.seen, (std::vector<std::uint8_t>{1, 2, 3}));
  for (const std::uint32_t c : {0xEEu, 1u, 2u}) EXPECT_EQ(b.system.bus_read(b.base("SPI1") + kRxdr, 1), c);
  b.set("SPI1", kIfcr, kEot | kTxtf);
  EXPECT_EQ(status() & (kEot | kTxtf), 0u);
}

// f = kernel / 2^(MBR + 1): 64 MHz (the PLLs are off, the bus's clock is taken) / 8, one core cycle a kernel clock.
TEST_F(H7Spi, AFrameTakesItsBitsOfThePrescaledKernelClock) {
  begin(8, 1, 2);
  b.system.bus_write(b.base("SPI1") + kTxdr, 1, 9);
  b.system.run_for(8 * 8 - 1);
  EXPECT_EQ(status() & kEot, 0u);
  b.system.run_for(1);
  EXPECT_EQ(status() & kEot, kEot);
}

TEST_F(H7Spi, WiderAccessesCarryPackedFramesAndWideFramesGoHighByteFirst) {
  begin(8, 4);
  b.system.bus_write(b.base("SPI1") + kTxdr, 4, 0x04030201);
  b.system.run_for(1000);
  EXPECT_EQ(echo.seen, (std::vector<std::uint8_t>{1, 2, 3, 4}));
  EXPECT_EQ(b.system.bus_read(b.base("SPI1") + kRxdr, 4), 0x030201EEu);
  b.set("SPI1", kIfcr, kEot | kTxtf);
  echo.seen.clear();
  begin(16, 1);
  b.system.bus_write(b.base("SPI1") + kTxdr, 2, 0xABCD);
  b.system.run_for(1000);
  EXPECT_EQ(echo.seen, (std::vector<std::uint8_t>{0xAB, 0xCD}));
}

TEST_F(H7Spi, ItsFifoHoldsSixteenBytesAndNothingMovesBeforeTheStart) {
  b.set("SPI1", kCfg1, 7);
  b.set("SPI1", kCr2, 0);
  b.set("SPI1", kCr1, kSpe);
  unsigned taken = 0;
  for (; taken < 40 && (status() & 2u) != 0; ++taken) b.system.bus_write(b.base("SPI1") + kTxdr, 1, 5);
  EXPECT_EQ(taken, 16u);
  b.system.run_for(10000);
  EXPECT_TRUE(echo.seen.empty());
  b.set("SPI1", kCr1, kSpe | kCstart);
  b.system.run_for(10000);
  EXPECT_EQ(echo.seen.size(), 16u);
}

TEST_F(H7Spi, DmaMovesBothWaysAndTheEndInterrupts) {
  for (unsigned i = 0; i < 20; ++i) b.system.memory[0x24000000 + i] = static_cast<std::uint8_t>(i + 1);
  b.set("DMAMUX1", 0, 37);  // SPI1_RX
  b.set("DMAMUX1", 4, 38);
  const auto stream = [&](unsigned s, std::uint32_t data, std::uint32_t memory, std::uint32_t direction) {
    b.set("DMA1", 0x14 + 24 * s, 20);
    b.set("DMA1", 0x18 + 24 * s, b.base("SPI1") + data);
    b.set("DMA1", 0x1C + 24 * s, memory);
    b.set("DMA1", 0x10 + 24 * s, 1u << 10 | direction << 6 | 1);
  };
  b.set("SPI1", kCfg1, 7 | 1u << 14);
  stream(0, kRxdr, 0x24001000, 0);
  stream(1, kTxdr, 0x24000000, 1);
  b.set("SPI1", kCfg1, 7 | 1u << 14 | 1u << 15);
  b.set("SPI1", kIer, kEot);
  b.set("SPI1", kCr2, 20);
  b.set("SPI1", kCr1, kSpe);
  b.set("SPI1", kCr1, kSpe | kCstart);
  b.system.run_for(10000);
  EXPECT_TRUE(b.system.irq_high[35]);
  EXPECT_EQ(echo.seen.size(), 20u);
  for (unsigned i = 1; i < 20; ++i) EXPECT_EQ(b.system.memory[0x24001000 + i], i) << i;
}

struct H7Can : testing::Test {
  // SIDFC: one filter at 0; FIFO 0 of three elements at 0x100; a dedicated buffer and a FIFO of two at 0x400.
  H7Can() {
    b.set("FDCAN1", 0x18, 3);
    b.set("FDCAN1", 0x1C, 0x06000A03);
    b.set("FDCAN1", 0x84, 1u << 16 | 0x000);
    b.set("FDCAN1", 0x80, 2u << 4 | 2u << 2);  // what no filter takes is refused
    b.set("FDCAN1", 0xA0, 3u << 16 | 0x100);
    b.set("FDCAN1", 0xC0, 2u << 24 | 1u << 16 | 0x400);
    ram(0, 2u << 30 | 1u << 27 | 0x120u << 16 | 0x7F0);  // 0x120 to 0x12F into FIFO 0
    b.set("FDCAN1", 0x54, 0xFFF);
    b.set("FDCAN1", 0x5C, 1);
    b.set("FDCAN1", 0x18, 0);
    can.on_transmit([this](const CanFrame& f, Cycles) { sent.push_back(f.id); });
  }
  void ram(std::uint32_t at, std::uint32_t word) { b.system.bus_write(0x4000AC00 + at, 4, word); }
  void put(unsigned buffer, std::uint32_t id) {
    ram(0x400 + 16 * buffer, id << 18);
    ram(0x404 + 16 * buffer, 2u << 16);
    ram(0x408 + 16 * buffer, 0x2211);
  }
  static CanFrame frame(std::uint32_t id) {
    CanFrame f;
    f.id = id;
    f.bytes = 3;
    f.data = {7, 8, 9};
    return f;
  }
  ChipBench b{"stm32h743"};
  CanPort& can = *b.chip.find<CanPort>("FDCAN1");
  std::vector<std::uint32_t> sent;
};

TEST_F(H7Can, ReceivesWhereTheImageHasLaidItsFifo) {
  can.receive(frame(0x345));
  EXPECT_EQ(b.get("FDCAN1", 0xA4) & 0x7F, 0u) << "no filter takes it";
  can.receive(frame(0x123));
  EXPECT_EQ(b.get("FDCAN1", 0xA4) & 0x7F, 1u);
  EXPECT_TRUE(b.system.irq_high[19]);
  EXPECT_EQ(b.system.bus_read(0x4000AC00 + 0x100, 4), 0x123u << 18);
  EXPECT_EQ(b.system.bus_read(0x4000AC00 + 0x104, 4), 3u << 16);
  EXPECT_EQ(b.system.bus_read(0x4000AC00 + 0x108, 4) & 0xFFFFFF, 0x090807u);
  b.set("FDCAN1", 0xA8, 0);
  EXPECT_EQ(b.get("FDCAN1", 0xA4), 1u << 8 | 1u << 16);
}

TEST_F(H7Can, AFullFifoRefusesTheNextAndSaysSo) {
  for (std::uint32_t i = 0; i < 4; ++i) can.receive(frame(0x120 + i));
  EXPECT_EQ(b.get("FDCAN1", 0xA4) & 0x0300007F, 0x03000003u);
  EXPECT_EQ(b.get("FDCAN1", 0x50) & 0xF, 1u | 4u | 8u);
  EXPECT_EQ(b.system.bus_read(0x4000AC00 + 0x100, 4), 0x120u << 18);
}

TEST_F(H7Can, TheDedicatedBufferGoesBeforeTheFifoByItsIdentifierAndTheFifoInOrder) {
  EXPECT_EQ(b.get("FDCAN1", 0xC4), 2u | 1u << 8 | 1u << 16) << "two places from 1 on";
  put(1, 0x300);
  b.set("FDCAN1", 0xD0, 2);  // on its way at once
  EXPECT_EQ(b.get("FDCAN1", 0xC4) >> 16 & 31, 2u);
  put(2, 0x200);
  b.set("FDCAN1", 0xD0, 4);
  EXPECT_EQ(b.get("FDCAN1", 0xC4) & 0x200000, 0x200000u) << "full";
  put(0, 0x100);
  b.set("FDCAN1", 0xD0, 1);
  b.system.run_for(200'000);
  EXPECT_EQ(sent, (std::vector<std::uint32_t>{0x300, 0x100, 0x200}));
  EXPECT_EQ(b.get("FDCAN1", 0xD8), 7u);
  EXPECT_EQ(b.get("FDCAN1", 0xC4), 2u | 1u << 8 | 1u << 16) << "round to the first place";
}

struct H7Serial : testing::Test {
  H7Serial() {
    b.set("USART3", 0x0C, 16);
    serial.on_transmit([this](std::uint8_t c, Cycles) { sent += static_cast<char>(c); });
  }
  void on(std::uint32_t more) { b.set("USART3", 0x00, 1u << 3 | 1u << 2 | 1 | more); }
  ChipBench b{"stm32h743"};
  Usart& serial = *b.chip.find<Usart>("USART3");
  std::string sent;
  static constexpr std::uint32_t kFifo = 1u << 29;
};

TEST_F(H7Serial, SixteenBytesWaitInEachFifo) {
  on(kFifo);
  unsigned written = 0;
  for (; written < 40 && (b.get("USART3", 0x1C) & 1u << 7) != 0; ++written)
    b.set("USART3", 0x28, 'a' + written);
  EXPECT_EQ(written, 17u) << "one is on its way";
  const std::vector<std::uint8_t> bytes(17, 0x55);
  serial.feed(bytes, b.system.to_ns(b.system.now()));
  b.system.run_for(20 * 160);
  EXPECT_EQ(sent, "abcdefghijklmnopq");
  EXPECT_EQ(b.get("USART3", 0x1C) & (1u << 24 | 1u << 3), 1u << 24 | 1u << 3) << "full, and one too many";
  unsigned read = 0;
  for (; read < 40 && (b.get("USART3", 0x1C) & 1u << 5) != 0; ++read) b.get("USART3", 0x24);
  EXPECT_EQ(read, 16u);
  EXPECT_EQ(serial.overruns(), 1u);
}

TEST_F(H7Serial, WithoutThemItIsOneByteAsEver) {
  on(0);
  b.set("USART3", 0x28, 'a');
  EXPECT_NE(b.get("USART3", 0x1C) & 1u << 7, 0u);
  b.set("USART3", 0x28, 'b');
  EXPECT_EQ(b.get("USART3", 0x1C) & 1u << 7, 0u);
}

TEST_F(H7Serial, AThresholdInterrupts) {
  b.set("USART3", 0x08, 2u << 25 | 1u << 28);  // RXFTIE at one half
  on(kFifo);
  serial.feed(std::vector<std::uint8_t>(7, 1), b.system.to_ns(b.system.now()));
  b.system.run_for(10 * 160);
  EXPECT_FALSE(b.system.irq_high[39]);
  serial.feed(std::vector<std::uint8_t>(1, 1), b.system.to_ns(b.system.now()));
  b.system.run_for(2 * 160);
  EXPECT_TRUE(b.system.irq_high[39]);
}

}  // namespace
}  // namespace omnihil::mcu
