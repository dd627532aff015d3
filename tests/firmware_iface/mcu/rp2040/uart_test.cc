// UART of the RP2040 against its formulas (§4.2; ARM DDI 0183G).
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/firmware_iface/mcu/rp2040/rp2040_bench.h"

namespace omnihil::mcu {
namespace {
enum : std::uint32_t {
  kDr = 0x00,
  kFr = 0x18,
  kIbrd = 0x24,
  kFbrd = 0x28,
  kLcr = 0x2C,
  kCr = 0x30,
  kIfls = 0x34,
  kImsc = 0x38,
  kRis = 0x3C,
  kIcr = 0x44
};
constexpr std::uint32_t kReceive = 1u << 4, kTransmit = 1u << 5, kTimeout = 1u << 6, kOverrun = 1u << 10;
constexpr Cycles kBit = 16 * 4;  // IBRD 4

struct UartBench : Rp2040Bench {
  UartBench() : port(*chip.find<SerialPort>("UART1")) {
    set("UART1", kIbrd, 4);
    set("UART1", kFbrd, 0);
    set("UART1", kLcr, 3u << 5 | 1u << 4);
    set("UART1", kCr, 0x301);
    port.on_transmit([this](std::uint8_t byte, Cycles at) { sent.emplace_back(byte, at); });
  }
  void come(int bytes) {
    const std::vector<std::uint8_t> them(static_cast<std::size_t>(bytes), 0x55);
    port.feed(them, system.to_ns(system.now()));
    system.run_for(static_cast<Cycles>(bytes) * 10 * kBit + 1);
  }
  SerialPort& port;
  std::vector<std::pair<std::uint8_t, Cycles>> sent;
};

// baud = clk_peri / (16 (IBRD + FBRD / 64)).
TEST(Rp2040Uart, ItsBaudIsThatOfItsDividers) {
  struct Row {
    std::uint32_t whole, part;
  };
  for (const Row row : {Row{1, 0}, {6, 50}, {67, 52}, {813, 51}, {65535, 0}}) {
    UartBench b;
    b.set("UART1", kIbrd, row.whole);
    b.set("UART1", kFbrd, row.part);
    const double wanted = 125e6 / (16 * (row.whole + row.part / 64.0));
    EXPECT_NEAR(b.port.baud(), wanted, 1e-9 * wanted);
  }
}

TEST(Rp2040Uart, AFrameIsAsLongAsItsFormatSays) {
  struct Row {
    std::uint32_t lcr;
    unsigned bits;
  };
  for (const Row row :
       {Row{3u << 5, 10}, {2u << 5, 9}, {3u << 5 | 2, 11}, {3u << 5 | 8, 11}, {3u << 5 | 10, 12}}) {
    UartBench b;
    b.set("UART1", kLcr, row.lcr | 1u << 4);
    const Cycles begin = b.system.now();
    b.set("UART1", kDr, 0x41);
    b.system.run_for(20 * kBit);
    ASSERT_EQ(b.sent.size(), 1u);
    EXPECT_EQ(b.sent[0].second - begin, row.bits * kBit) << row.bits;
  }
}

// IFLS: at 1/8, 1/4, 1/2, 3/4, 7/8 of 32.
TEST(Rp2040Uart, TheReceiveInterruptComesAtItsLevelAndGoesBelowIt) {
  constexpr int kLevels[] = {4, 8, 16, 24, 28};
  for (std::uint32_t select = 0; select < 5; ++select) {
    UartBench b;
    b.set("UART1", kIfls, select << 3);
    b.set("UART1", kImsc, kReceive);
    b.come(kLevels[select] - 1);
    EXPECT_FALSE(b.system.irq_high[21]) << select;
    b.come(1);
    EXPECT_TRUE(b.system.irq_high[21]) << select;
    b.get("UART1", kDr);
    EXPECT_FALSE(b.system.irq_high[21]) << select;
  }
}

TEST(Rp2040Uart, TheTransmitInterruptComesWhenItsFifoFallsToItsLevel) {
  constexpr Cycles kLevels[] = {4, 8, 16, 24, 28};
  for (std::uint32_t select = 0; select < 5; ++select) {
    UartBench b;
    b.set("UART1", kIfls, select);
    b.set("UART1", kImsc, kTransmit);
    EXPECT_FALSE(b.system.irq_high[21]) << "nothing was ever written";
    for (std::uint32_t i = 0; i < 33; ++i) b.set("UART1", kDr, i);  // one in the shifter
    EXPECT_NE(b.get("UART1", kFr) & 1u << 5, 0u) << "full";
    b.system.run_for((32 - kLevels[select]) * 10 * kBit - 1);
    EXPECT_FALSE(b.system.irq_high[21]) << select;
    b.system.run_for(1);
    EXPECT_TRUE(b.system.irq_high[21]) << select;
    b.set("UART1", kIcr, kTransmit);
    b.system.run_for(40 * 10 * kBit);
    EXPECT_FALSE(b.system.irq_high[21]) << "once";
    ASSERT_EQ(b.sent.size(), 33u);
    EXPECT_EQ(b.get("UART1", kFr) & (1u << 7 | 1u << 3), 1u << 7) << "empty, not busy";
  }
}

TEST(Rp2040Uart, ReceivedBytesTimeOutAfter32Bits) {
  UartBench b;
  b.set("UART1", kImsc, kTimeout);
  b.come(3);
  b.system.run_for(32 * kBit - 2);
  EXPECT_FALSE(b.system.irq_high[21]);
  b.system.run_for(2);
  EXPECT_TRUE(b.system.irq_high[21]);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(b.system.irq_high[21]) << i;
    b.get("UART1", kDr);
  }
  EXPECT_FALSE(b.system.irq_high[21]);
}

TEST(Rp2040Uart, TheThirtyThirdByteIsLostAndSaid) {
  UartBench b;
  b.come(32);
  EXPECT_EQ(b.get("UART1", kRis) & kOverrun, 0u);
  EXPECT_NE(b.get("UART1", kFr) & 1u << 6, 0u) << "full";
  b.come(1);
  EXPECT_NE(b.get("UART1", kRis) & kOverrun, 0u);
  for (int i = 0; i < 32; ++i) EXPECT_EQ(b.get("UART1", kDr) & 0xFF, 0x55u);
  EXPECT_NE(b.get("UART1", kFr) & 1u << 4, 0u) << "empty";
  b.come(1);
  EXPECT_EQ(b.get("UART1", kDr), 0x855u) << "OE stands at the byte behind the gap";
  b.come(1);
  EXPECT_EQ(b.get("UART1", kDr), 0x55u);
}

}  // namespace
}  // namespace omnihil::mcu
