// Converters sample at their instants; CAN frames take their time on the wire and pass filters.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "firmware_iface/mcu/stm32/bxcan.h"
#include "firmware_iface/mcu/stm32/fdcan.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

TEST(Converter, TakesTheVoltageOfTheEndOfItsSamplingTime) {
  ChipBench b("stm32f407");
  std::int64_t asked_ns = -1;
  b.chip.find<Adc>("ADC1")->set_source(5, [&](std::int64_t at_ns) {
    asked_ns = at_ns;
    return 1.65;
  });
  b.set("ADC1", 0x10, 2u << 15);  // channel 5: 28 clocks
  b.set("ADC1", 0x34, 5);
  b.set("ADC1", 0x08, 1);
  b.set("ADC1", 0x08, 1 | 1u << 30);
  b.system.run_for(2 * (28 + 12) - 1);  // PCLK2 / 2
  EXPECT_EQ(b.get("ADC1", 0x00) & 2, 0u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("ADC1", 0x00) & 2, 2u);
  EXPECT_EQ(b.get("ADC1", 0x4C), 2048u);
  EXPECT_EQ(b.get("ADC1", 0x00) & 2, 0u);
  EXPECT_EQ(asked_ns, b.system.to_ns(56));
}

TEST(Converter, ClipsAndReportsAnInputThatNothingIsConnectedTo) {
  ChipBench b("stm32f407");
  b.chip.find<Adc>("ADC1")->set_source(0, [](std::int64_t) { return 9.0; });
  b.chip.find<Adc>("ADC1")->set_source(1, [](std::int64_t) { return -9.0; });
  for (const auto& [channel, code] : {std::pair{0u, 4095u}, {1u, 0u}, {2u, 0u}}) {
    b.set("ADC1", 0x34, channel);
    b.set("ADC1", 0x08, 1);
    b.set("ADC1", 0x08, 1 | 1u << 30);
    b.system.run_for(1000);
    EXPECT_EQ(b.get("ADC1", 0x4C), code);
  }
  EXPECT_EQ(b.system.unmodelled.size(), 1u);
}

TEST(Converter, InjectedConversionsFollowATimerTriggerWithinItsPeriod) {
  ChipBench b("stm32f407");
  std::vector<std::int64_t> instants;
  b.chip.find<Adc>("ADC1")->set_source(3, [&](std::int64_t at_ns) {
    instants.push_back(at_ns);
    return 0.0;
  });
  b.set("TIM1", 0x2C, 1599);
  b.set("TIM1", 0x40, 800);
  b.set("TIM1", 0x1C, 7u << 12);  // channel 4: PWM 2, rises at the match
  b.set("TIM1", 0x14, 1);
  b.set("ADC1", 0x38, 3u << 15);
  b.set("ADC1", 0x08, 1 | 1u << 20);  // JEXTEN rising, JEXTSEL 0: TIM1_CC4
  b.set("TIM1", 0x00, 1);
  b.system.run_for(1600 * 5);
  ASSERT_EQ(instants.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(instants[i], b.system.to_ns(1600 * i + 800 + 2 * 3));
  EXPECT_EQ(b.get("ADC1", 0x00) & 4, 4u);
}

TEST(Converter, F3CalibratesEnablesAndScansByDma) {
  ChipBench b("stm32f303");
  for (unsigned c = 1; c <= 3; ++c)
    b.chip.find<Adc>("ADC1")->set_source(c, [c](std::int64_t) { return 0.5 * c; });
  b.set("ADC1", 0x08, 1u << 28);
  b.set("ADC1", 0x08, 1u << 28 | 1u << 31);
  EXPECT_EQ(b.get("ADC1", 0x08) >> 31, 0u);
  b.set("ADC1", 0x08, 1u << 28 | 1);
  EXPECT_EQ(b.get("ADC1", 0x00) & 1, 1u);
  b.set("ADC1", 0x30, 2 | 1u << 6 | 2u << 12 | 3u << 18);
  b.set("ADC1", 0x0C, 1 | 1u << 1);
  b.set("DMA1", 0x0C, 3);
  b.set("DMA1", 0x10, b.base("ADC1") + 0x40);
  b.set("DMA1", 0x14, 0x20000000);
  b.set("DMA1", 0x08, 1u << 10 | 1u << 8 | 1u << 7 | 1);
  b.set("ADC1", 0x08, 1u << 28 | 4);
  b.system.run_for(1000);
  for (std::uint32_t c = 1; c <= 3; ++c) {
    EXPECT_EQ(b.system.bus_read(0x20000000 + 2 * (c - 1), 2),
              static_cast<std::uint32_t>(0.5 * c / 3.3 * 4096 + 0.5));
  }
  EXPECT_EQ(b.get("ADC1", 0x08) & 4, 0u);
}

TEST(Converter, F0ScansTheSelectedChannelsUpwards) {
  ChipBench b("stm32f031");
  for (const unsigned c : {2u, 7u})
    b.chip.find<Adc>("ADC1")->set_source(c, [c](std::int64_t) { return 0.1 * c; });
  b.set("ADC1", 0x28, 1u << 2 | 1u << 7);
  b.set("ADC1", 0x08, 1);
  b.set("ADC1", 0x08, 4);
  for (const unsigned c : {2u, 7u}) {
    for (int i = 0; i < 1000 && (b.get("ADC1", 0x00) & 4) == 0; ++i) b.system.run_for(1);
    EXPECT_EQ(b.get("ADC1", 0x40), static_cast<std::uint32_t>(0.1 * c / 3.3 * 4096 + 0.5));
  }
}

TEST(CanWire, AFrameOfAlternatingBitsHasNoStuffing) {
  CanFrame frame;
  frame.id = 0x555;
  frame.bytes = 8;
  frame.data.fill(0x55);
  const unsigned plain = 44 + 64 + 3;
  EXPECT_GE(can_frame_bits(frame), plain);
  EXPECT_LE(can_frame_bits(frame), plain + 4);  // DLC and CRC may bring some
  frame.data.fill(0);
  EXPECT_GT(can_frame_bits(frame), plain + 12);
  EXPECT_LE(can_frame_bits(frame), plain + 24);  // the most that ISO 11898 allows
}

TEST(BxCan, InitialisationIsAcknowledgedEvenWhileAsleep) {
  ChipBench b("stm32f303");
  EXPECT_EQ(b.get("CAN1", 0x04) & 3, 2u);
  b.set("CAN1", 0x00, 3);
  EXPECT_EQ(b.get("CAN1", 0x04) & 3, 1u);
  b.set("CAN1", 0x00, 0);
  EXPECT_EQ(b.get("CAN1", 0x04) & 3, 0u);
}

struct CanBench : ChipBench {
  CanBench() : ChipBench("stm32f303") {
    can = chip.find<BxCan>("CAN1");
    set("CAN1", 0x00, 1);
    set("CAN1", 0x1C, 0u | 4u << 16 | 1u << 20);  // 8 MHz: 8 quanta, 1 Mbit/s
    set("CAN1", 0x204, 1);                        // bank 0: list of four standard ids
    set("CAN1", 0x240, 0x100u << 5 | 0x101u << 21);
    set("CAN1", 0x244, 0x110u << 5 | 0x310u << 21);
    set("CAN1", 0x214, 1);  // to FIFO 1
    set("CAN1", 0x21C, 1);
    set("CAN1", 0x200, 0x2A1C0E00);
    set("CAN1", 0x00, 0);
  }
  BxCan* can;
};

TEST(BxCan, ThreeMailboxesLeaveByPriorityInWireTime) {
  CanBench b;
  std::vector<std::pair<std::uint32_t, Cycles>> sent;
  b.can->on_transmit([&](const CanFrame& f, Cycles end) { sent.emplace_back(f.id, end); });
  const Cycles start = b.system.now();
  CanFrame first;
  first.id = 0x300;
  first.bytes = 8;
  for (const auto& [mailbox, id] : {std::pair{0u, 0x300u}, {1u, 0x200u}, {2u, 0x100u}}) {
    b.set("CAN1", 0x184 + 16 * mailbox, 8);
    b.set("CAN1", 0x180 + 16 * mailbox, id << 21 | 1);
  }
  EXPECT_EQ(b.get("CAN1", 0x08) >> 26 & 7, 0u);
  b.system.run_for(8 * 400);
  ASSERT_EQ(sent.size(), 3u);
  EXPECT_EQ(sent[0].first, 0x300u);  // had begun already
  EXPECT_EQ(sent[0].second, start + 8 * can_frame_bits(first));
  EXPECT_EQ(sent[1].first, 0x100u);
  EXPECT_EQ(sent[2].first, 0x200u);
  EXPECT_EQ(b.get("CAN1", 0x08) & 0x1F030303, 0x1C030303u);
}

TEST(BxCan, FiltersChooseTheFifoAndTheFourthFrameOverruns) {
  CanBench b;
  b.set("CAN1", 0x14, 1u << 4);  // FMPIE1
  CanFrame frame;
  frame.bytes = 2;
  frame.data[0] = 0x12;
  frame.id = 0x102;
  b.can->receive(frame);
  EXPECT_EQ(b.get("CAN1", 0x10) & 3, 0u);
  for (const std::uint32_t id : {0x100u, 0x310u, 0x110u, 0x101u}) {
    frame.id = id;
    b.can->receive(frame);
  }
  EXPECT_TRUE(b.system.irq_high[21]);
  EXPECT_EQ(b.get("CAN1", 0x10) & 0x1B, 0x1Bu);  // three waiting, full, overrun
  EXPECT_EQ(b.get("CAN1", 0x1C0) >> 21, 0x100u);
  EXPECT_EQ(b.get("CAN1", 0x1C8) & 0xFF, 0x12u);
  for (int i = 0; i < 3; ++i) b.set("CAN1", 0x10, 1u << 5);
  EXPECT_EQ(b.get("CAN1", 0x10) & 3, 0u);
  EXPECT_FALSE(b.system.irq_high[21]);
}

// HAL's field for it left at 0 gives all filters to the second controller; while that is off the first still uses them.
TEST(BxCan, FiltersOfASecondControllerThatIsOffWorkForTheFirst) {
  ChipBench b("stm32f446");
  b.set("CAN1", 0x00, 1);
  b.set("CAN1", 0x200, 0x2A1C0001);  // CAN2SB 0
  b.set("CAN1", 0x20C, 1);
  b.set("CAN1", 0x240, 1u << 21);
  b.set("CAN1", 0x244, 0x0FFF0000);
  b.set("CAN1", 0x21C, 1);
  b.set("CAN1", 0x200, 0x2A1C0000);
  b.set("CAN1", 0x00, 0);
  CanFrame frame;
  frame.id = 1;
  frame.bytes = 8;
  b.chip.find<BxCan>("CAN1")->receive(frame);
  EXPECT_EQ(b.get("CAN1", 0x0C) & 3, 1u);
  b.set("CAN2", 0x00, 1);
  b.set("CAN2", 0x00, 0);
  b.chip.find<BxCan>("CAN1")->receive(frame);
  EXPECT_EQ(b.get("CAN1", 0x0C) & 3, 1u) << "now they are the second's";
  b.chip.find<BxCan>("CAN2")->receive(frame);
  EXPECT_EQ(b.get("CAN2", 0x0C) & 3, 1u);
}

TEST(Fdcan, SendsFromMessageRamAndReceivesIntoIt) {
  ChipBench b("stm32g474");
  Fdcan& can = *b.chip.find<Fdcan>("FDCAN1");
  CanFrame sent;
  can.on_transmit([&](const CanFrame& f, Cycles) { sent = f; });
  constexpr std::uint32_t kRam = 0x4000A400;
  b.set("FDCAN1", 0x18, 3 | 1u << 8 | 1u << 9);
  b.system.write(kRam, 2u << 30 | 1u << 27 | 0x123u << 16 | 0x7FFu);  // mask filter to FIFO 0
  b.set("FDCAN1", 0x80, 1u << 16 | 2u << 4 | 2u << 2);                // one filter, reject the rest
  b.set("FDCAN1", 0x54, 1);
  b.set("FDCAN1", 0x5C, 1);
  b.set("FDCAN1", 0x18, 1u << 8 | 1u << 9);
  b.system.write(kRam + 0x278, 0x321u << 18);
  b.system.write(kRam + 0x27C, 1u << 21 | 1u << 20 | 9u << 16);  // FD with 12 bytes
  b.system.write(kRam + 0x280, 0x04030201);
  b.set("FDCAN1", 0xCC, 1);
  EXPECT_EQ(b.get("FDCAN1", 0xC8), 1u);
  b.system.run_for(100'000);
  EXPECT_EQ(sent.id, 0x321u);
  EXPECT_EQ(sent.bytes, 12);
  EXPECT_TRUE(sent.fd && sent.fast);
  EXPECT_EQ(sent.data[3], 4);
  EXPECT_EQ(b.get("FDCAN1", 0xD4), 1u);
  CanFrame frame;
  frame.id = 0x124;
  frame.bytes = 4;
  can.receive(frame);
  EXPECT_EQ(b.get("FDCAN1", 0x90) & 0xF, 0u);
  frame.id = 0x123;
  frame.data[0] = 0x77;
  can.receive(frame);
  EXPECT_EQ(b.get("FDCAN1", 0x90) & 0xF, 1u);
  EXPECT_TRUE(b.system.irq_high[21]);
  EXPECT_EQ(b.system.read(kRam + 0xB0) >> 18 & 0x7FF, 0x123u);
  EXPECT_EQ(b.system.read(kRam + 0xB8) & 0xFF, 0x77u);
  b.set("FDCAN1", 0x94, 0);
  EXPECT_EQ(b.get("FDCAN1", 0x90) & 0xF, 0u);
}

// Filters of G4's FDCAN1 in the message RAM, the rest rejected: where a frame goes, below 0 nowhere.
class FdcanFilters : public testing::Test {
 protected:
  static constexpr std::uint32_t kRam = 0x4000A400;
  void standard(unsigned place, unsigned kind, unsigned action, std::uint32_t id1, std::uint32_t id2) {
    b_.system.write(kRam + 4 * place, kind << 30 | action << 27 | id1 << 16 | id2);
  }
  void extended(unsigned place, unsigned kind, unsigned action, std::uint32_t id1, std::uint32_t id2) {
    b_.system.write(kRam + 0x70 + 8 * place, action << 29 | id1);
    b_.system.write(kRam + 0x74 + 8 * place, kind << 30 | id2);
  }
  void start(std::uint32_t extended_mask = 0x1FFFFFFF) {
    b_.set("FDCAN1", 0x18, 3);
    b_.set("FDCAN1", 0x80, 2u << 24 | 2u << 16 | 2u << 4 | 2u << 2);
    b_.set("FDCAN1", 0x84, extended_mask);
    b_.set("FDCAN1", 0x18, 0);
  }
  int fifo_of(std::uint32_t id, bool is_extended) {
    CanFrame frame;
    frame.id = id;
    frame.extended = is_extended;
    b_.chip.find<Fdcan>("FDCAN1")->receive(frame);
    for (const int fifo : {0, 1}) {
      const std::uint32_t status = b_.get("FDCAN1", fifo == 0 ? 0x90 : 0x98);
      if ((status & 0xF) == 0) continue;
      b_.set("FDCAN1", fifo == 0 ? 0x94 : 0x9C, status >> 8 & 3);
      return fifo;
    }
    return -1;
  }
  ChipBench b_{"stm32g474"};
};

// RM0440 §44.3.8: filtering stops at the first element that matches, also where that only sets a priority.
TEST_F(FdcanFilters, TheFirstThatMatchesDecidesWhateverItDoes) {
  standard(0, 1, 4, 0x100, 0x101);  // set priority
  standard(1, 0, 1, 0x100, 0x1FF);  // to FIFO 0
  start();
  EXPECT_EQ(fifo_of(0x100, false), -1);
  EXPECT_EQ(fifo_of(0x102, false), 0);
  standard(0, 1, 3, 0x100, 0x101);  // reject
  EXPECT_EQ(fifo_of(0x101, false), -1);
  standard(0, 1, 7, 0x100, 0x101);  // reserved: the element is disabled
  EXPECT_EQ(fifo_of(0x101, false), 0);
}

// §44.3.4: XIDAM masks what is received before the filters see it, but of a range of kind 3.
TEST_F(FdcanFilters, TheExtendedMaskIsAppliedBeforeTheFilters) {
  extended(0, 1, 1, 0x00000123, 0x00000123);
  extended(1, 3, 2, 0x10000000, 0x10000FFF);
  start(0x000003FF);
  EXPECT_EQ(fifo_of(0x0ABC0123, true), 0) << "but for the bits that are masked";
  EXPECT_EQ(fifo_of(0x0ABC0124, true), -1);
  EXPECT_EQ(fifo_of(0x10000124, true), 1) << "a range without the mask";
  EXPECT_EQ(fifo_of(0x00000124, true), -1);
}

}  // namespace
}  // namespace omnihil::mcu
