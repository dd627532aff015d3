// State machines of the RP2040's PIO against §3.2 to §3.5 of its datasheet.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/firmware_iface/mcu/rp2040/rp2040_bench.h"

namespace omnihil::mcu {
namespace {
enum : std::uint32_t {
  kCtrl = 0x00,
  kFstat = 0x04,
  kFdebug = 0x08,
  kFlevel = 0x0C,
  kTx = 0x10,
  kRx = 0x20,
  kIrq = 0x30,
  kMemory = 0x48,
  kClkdiv = 0xC8,
  kExec = 0xCC,
  kShift = 0xD0,
  kAddr = 0xD4,
  kInstr = 0xD8,
  kPins0 = 0xDC,
  kInte0 = 0x12C
};
constexpr std::uint32_t kNext = 0x18;  // from a machine's registers to the next one's

// Instructions (§3.4), without delay and side-set.
constexpr std::uint32_t jmp(std::uint32_t to, std::uint32_t condition = 0) { return condition << 5 | to; }
constexpr std::uint32_t in(std::uint32_t from, std::uint32_t bits) {
  return 0x4000 | from << 5 | (bits & 31);
}
constexpr std::uint32_t out(std::uint32_t to, std::uint32_t bits) { return 0x6000 | to << 5 | (bits & 31); }
constexpr std::uint32_t mov(std::uint32_t to, std::uint32_t from, std::uint32_t how = 0) {
  return 0xA000 | to << 5 | how << 3 | from;
}
constexpr std::uint32_t put(std::uint32_t to, std::uint32_t value) { return 0xE000 | to << 5 | value; }
constexpr std::uint32_t kPush = 0x8020, kPull = 0x80A0, kNop = 0xA042;
constexpr std::uint32_t delay(std::uint32_t cycles) { return cycles << 8; }
enum : std::uint32_t { kPinsOf = 0, kX = 1, kY = 2, kNull = 3, kPindirs = 4, kExecute = 7 };

struct PioBench : Rp2040Bench {
  void program(const std::vector<std::uint32_t>& words) {
    for (std::uint32_t i = 0; i < words.size(); ++i) set("PIO0", kMemory + 4 * i, words[i]);
    set("PIO0", kExec,
        (get("PIO0", kExec) & ~0x1FF80u) | (static_cast<std::uint32_t>(words.size()) - 1) << 12);
  }
  // Pin of machine 0 by SET, OUT and side-set; as an output.
  void drives(unsigned pin, std::uint32_t side_bits = 0) {
    give(pin, IoBank::kPio0);
    set("PIO0", kPins0, 1u << 26 | 1u << 20 | pin << 5 | pin | pin << 10);
    set("PIO0", kInstr, put(kPindirs, 1));
    set("PIO0", kPins0, 1u << 26 | 1u << 20 | pin << 5 | pin | pin << 10 | side_bits << 29);
    pins().on_output(pin, [this](bool level) { edges.emplace_back(system.now() - begun, level); });
  }
  void start(std::uint32_t machines = 1) {
    begun = system.now();
    edges.clear();
    set("PIO0", kCtrl, machines);
  }
  bool rx_empty() { return (get("PIO0", kFstat) & 1u << 8) != 0; }
  Cycles begun = 0;
  std::vector<std::pair<Cycles, bool>> edges;
};

TEST(Rp2040Pio, AutopushPushesEachTimeItsThresholdOfBitsIsIn) {
  PioBench b;
  b.program({put(kX, 0x15), in(kX, 5)});
  b.set("PIO0", kShift, 1u << 16 | 10u << 20);  // to the left, of 10 bits
  b.start();
  b.system.run_for(100);
  EXPECT_EQ(b.get("PIO0", kFlevel) & 0xFF, 0x40u) << "full";
  EXPECT_NE(b.get("PIO0", kFdebug) & 1, 0u) << "and stalled";
  for (int i = 0; i < 6; ++i) {
    ASSERT_FALSE(b.rx_empty());
    EXPECT_EQ(b.get("PIO0", kRx), 0x15u << 5 | 0x15u) << i;
    b.system.run_for(20);
  }
}

TEST(Rp2040Pio, BitsShiftedInFromTheLeftStandAtTheTop) {
  PioBench b;
  b.program({put(kX, 0x3), in(kX, 2), put(kX, 0), in(kX, 1), kPush, jmp(5)});
  b.set("PIO0", kShift, 1u << 18);
  b.start();
  b.system.run_for(50);
  EXPECT_EQ(b.get("PIO0", kRx), 3u << 29);
}

// A serial output: OUT of one bit each second cycle, words without a gap while the FIFO has some.
TEST(Rp2040Pio, AutopullFeedsOutWithoutAGap) {
  PioBench b;
  b.drives(3);
  b.program({out(kPinsOf, 1) | delay(1)});
  b.set("PIO0", kShift, 1u << 17 | 1u << 19 | 8u << 25);  // to the right, of 8 bits
  b.set("PIO0", kTx, 0x55);
  b.set("PIO0", kTx, 0x55);
  b.start();
  b.system.run_for(200);
  ASSERT_EQ(b.edges.size(), 16u);
  for (std::size_t i = 1; i < b.edges.size(); ++i)
    EXPECT_EQ(b.edges[i].first - b.edges[i - 1].first, 2u) << i;
  EXPECT_NE(b.get("PIO0", kFdebug) & 1u << 24, 0u) << "then it stalls";
}

// The shift register is filled in the background of other instructions (§3.5.4.2): the OUT behind them does not stall.
TEST(Rp2040Pio, AutopullFillsInTheBackgroundOfOtherInstructions) {
  PioBench b;
  b.program({kNop, kNop, jmp(0)});
  b.set("PIO0", kShift, 1u << 17 | 1u << 19);
  b.start();
  b.system.run_for(30);
  b.set("PIO0", kTx, 0xABCD);
  b.system.run_for(5);
  EXPECT_EQ(b.get("PIO0", kFlevel) & 0xF, 0u) << "taken, though nobody asked";
  b.set("PIO0", kTx, 1);
  b.system.run_for(5);
  EXPECT_EQ(b.get("PIO0", kFlevel) & 0xF, 1u) << "it is full";
}

TEST(Rp2040Pio, PullIsNothingWhereAutopullHasFilled) {
  PioBench b;
  b.program({kNop, kPull, mov(kX, 7), mov(6, kX), kPush, jmp(5)});
  b.set("PIO0", kShift, 1u << 17 | 1u << 19);
  b.set("PIO0", kTx, 111);
  b.set("PIO0", kTx, 222);
  b.start();
  b.system.run_for(50);
  EXPECT_EQ(b.get("PIO0", kRx), 111u);
  EXPECT_EQ(b.get("PIO0", kFlevel) & 0xF, 1u);
}

TEST(Rp2040Pio, PullWithoutBlockingTakesXWhereThereIsNothing) {
  PioBench b;
  b.program({put(kX, 9), 0x8080, mov(6, 7), kPush, jmp(4)});
  b.start();
  b.system.run_for(20);
  EXPECT_EQ(b.get("PIO0", kRx), 9u);
}

TEST(Rp2040Pio, PushWithoutBlockingDropsAndClearsWhereThereIsNoRoom) {
  PioBench b;
  b.program({put(kX, 1), in(kX, 32), 0x8000, jmp(1)});
  b.start();
  b.system.run_for(100);
  EXPECT_EQ(b.get("PIO0", kFlevel) & 0xFF, 0x40u);
  EXPECT_NE(b.get("PIO0", kFdebug) & 1, 0u);
}

TEST(Rp2040Pio, JoinedFifosAreEightDeepAndTheOtherIsNone) {
  PioBench b;
  b.set("PIO0", kShift, 1u << 30);
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(b.get("PIO0", kFstat) & 1u << 16, 0u) << i;
    b.set("PIO0", kTx, i);
  }
  EXPECT_NE(b.get("PIO0", kFstat) & 1u << 16, 0u);
  EXPECT_EQ(b.get("PIO0", kFlevel) & 0xFF, 8u);
  b.set("PIO0", kTx, 9);
  EXPECT_NE(b.get("PIO0", kFdebug) & 1u << 16, 0u) << "TXOVER";
  b.set("PIO0", kShift, 0);
  EXPECT_EQ(b.get("PIO0", kFlevel) & 0xFF, 0u) << "joined otherwise, both are emptied";
}

// Side-set is there at its instruction's begin, its delay is in the bits that it leaves.
TEST(Rp2040Pio, SideSetComesWithItsInstructionAndLeavesTheDelay) {
  PioBench b;
  b.drives(5, 1);
  b.program({kNop | 1u << 12 | delay(6), kNop | delay(2)});
  b.start();
  b.system.run_for(100);
  ASSERT_GT(b.edges.size(), 6u);
  for (std::size_t i = 1; i < b.edges.size(); ++i)
    EXPECT_EQ(b.edges[i].first - b.edges[i - 1].first, b.edges[i].second ? 3u : 7u) << i;
}

TEST(Rp2040Pio, OptionalSideSetLeavesThePinWhereItIsNotAskedFor) {
  PioBench b;
  b.drives(5, 2);
  b.set("PIO0", kExec, 1u << 30);
  b.program({kNop | 3u << 11, kNop | 1u << 11 | delay(3), kNop | 2u << 11});
  b.start();
  b.system.run_for(60);
  ASSERT_GT(b.edges.size(), 6u);
  for (std::size_t i = 1; i < b.edges.size(); ++i)
    EXPECT_EQ(b.edges[i].first - b.edges[i - 1].first, b.edges[i].second ? 1u : 5u) << i;
}

TEST(Rp2040Pio, SideSetIsThereWhileItsInstructionStalls) {
  PioBench b;
  b.drives(5, 1);
  b.program({kNop, kPull | 1u << 12});
  b.start();
  b.system.run_for(50);
  ASSERT_EQ(b.edges.size(), 1u);
  EXPECT_TRUE(b.pins().level(5));
}

// §3.5.6: where a side-set and a SET or OUT of one cycle meet, the side-set is what is seen.
TEST(Rp2040Pio, SideSetGoesBeforeSetOfTheSamePin) {
  PioBench b;
  b.drives(5, 1);
  b.program({put(kPinsOf, 0) | 1u << 12});
  b.start();
  b.system.run_for(20);
  EXPECT_TRUE(b.pins().level(5));
}

// n instructions take n (INT + FRAC / 256) cycles on the average.
TEST(Rp2040Pio, TheClockDividersFractionIsInTheTimeOfManyInstructions) {
  for (const std::uint32_t div : {0x100u, 0x180u, 0x27Fu, 0x2501u, 0x7D00u}) {
    PioBench b;
    b.drives(3);
    b.set("PIO0", kClkdiv, div << 8);
    b.program({put(kPinsOf, 1) | delay(3), put(kPinsOf, 0) | delay(5)});
    b.start();
    constexpr std::size_t kTurns = 64;
    b.system.run_for(kTurns * 10 * div / 256 + div);
    ASSERT_GT(b.edges.size(), 2 * kTurns);
    const double took = static_cast<double>(b.edges[2 * kTurns].first - b.edges[0].first);
    EXPECT_NEAR(took, kTurns * 10 * (div / 256.0), 1.0) << div;
    for (std::size_t i = 1; i < 2 * kTurns; ++i) {
      EXPECT_NEAR(static_cast<double>(b.edges[i].first - b.edges[i - 1].first),
                  (b.edges[i].second ? 6 : 4) * (div / 256.0), 1.0)
          << i;
    }
  }
}

TEST(Rp2040Pio, AWholePartOfZeroIs65536) {
  PioBench b;
  b.drives(3);
  b.set("PIO0", kClkdiv, 0);
  b.program({put(kPinsOf, 1), put(kPinsOf, 0)});
  b.start();
  b.system.run_for(5 * 65536 + 10);
  ASSERT_GT(b.edges.size(), 2u);
  EXPECT_EQ(b.edges[2].first - b.edges[1].first, 65536u);
}

// Machine 0 raises flag 4 and waits until somebody has cleared it; machine 1 waits for it, which clears it.
TEST(Rp2040Pio, IrqWaitStandsUntilTheOtherMachinesWaitHasClearedTheFlag) {
  PioBench b;
  b.program({0xC020 | 4, put(kX, 1), mov(6, kX), kPush, jmp(4)});
  b.start();
  b.system.run_for(50);
  EXPECT_EQ(b.get("PIO0", kIrq), 1u << 4);
  EXPECT_EQ(b.get("PIO0", kAddr), 0u);
  b.set("PIO0", kMemory + 4 * 10, 0x20C0 | 4);  // wait 1 irq 4
  b.set("PIO0", kMemory + 4 * 11, jmp(11));
  b.set("PIO0", kInstr + kNext, jmp(10));
  b.set("PIO0", kCtrl, 3);
  b.system.run_for(20);
  EXPECT_EQ(b.get("PIO0", kIrq), 0u);
  EXPECT_EQ(b.get("PIO0", kAddr + kNext), 11u);
  EXPECT_EQ(b.get("PIO0", kRx), 1u);
}

TEST(Rp2040Pio, ARelativeFlagIsThatOfTheMachinesNumberModuloFour) {
  PioBench b;
  b.program({0xC010 | 1, jmp(1)});  // irq nowait 1 rel
  b.set("PIO0", kCtrl, 0xF);
  b.system.run_for(20);
  EXPECT_EQ(b.get("PIO0", kIrq), 0xFu);
  b.set("PIO0", kIrq, 0xFF);
  b.set("PIO0", kMemory, 0xC010 | 6);  // the third bit of the index stays
  b.set("PIO0", kInstr + 3 * kNext, 0xC010 | 6);
  EXPECT_EQ(b.get("PIO0", kIrq), 1u << (4 | ((2 + 3) & 3)));
}

TEST(Rp2040Pio, AFlagInterruptsTheCoreUntilItIsCleared) {
  PioBench b;
  b.set("PIO0", kInte0, 1u << 8);
  b.program({kNop | delay(9), 0xC020, jmp(2)});  // irq wait 0
  b.start();
  b.system.run_for(10);
  EXPECT_FALSE(b.system.irq_high[7]);
  b.system.run_for(2);
  EXPECT_TRUE(b.system.irq_high[7]);
  EXPECT_EQ(b.get("PIO0", kAddr), 1u);
  b.set("PIO0", kIrq, 1);
  EXPECT_FALSE(b.system.irq_high[7]);
  b.system.run_for(3);
  EXPECT_EQ(b.get("PIO0", kAddr), 2u);
}

// §3.4.5, OUT EXEC: the delay of the OUT itself is not taken, that of what it runs is.
TEST(Rp2040Pio, OutExecTakesTheDelayOfWhatItRunsAlone) {
  PioBench b;
  b.drives(3);
  b.program({put(kPinsOf, 1), out(kExecute, 16) | delay(20), put(kPinsOf, 0), jmp(3)});
  b.set("PIO0", kShift, 1u << 19 | 1u << 17);
  b.set("PIO0", kTx, kNop | delay(6));
  b.start();
  b.system.run_for(100);
  ASSERT_EQ(b.edges.size(), 2u);
  EXPECT_EQ(b.edges[1].first - b.edges[0].first, 1u + 1u + 7u) << "SET with the filling behind it, OUT, NOP";
}

TEST(Rp2040Pio, MovExecTakesTheDelayOfWhatItRunsAlone) {
  PioBench b;
  b.drives(3);
  b.program({kPull, put(kPinsOf, 1), mov(4, 7) | delay(20), put(kPinsOf, 0), jmp(4)});
  b.set("PIO0", kTx, kNop | delay(6));
  b.start();
  b.system.run_for(100);
  ASSERT_EQ(b.edges.size(), 2u);
  EXPECT_EQ(b.edges[1].first - b.edges[0].first, 1u + 1u + 7u);
}

TEST(Rp2040Pio, AnInstructionWrittenToAStoppedMachineSeesThePinsAsTheyAre) {
  PioBench b;
  b.pins().drive(12, true);
  b.set("PIO0", kPins0, 12u << 15);
  b.set("PIO0", kInstr, in(0, 1));  // from the left, as after reset
  b.set("PIO0", kInstr, kPush);
  EXPECT_EQ(b.get("PIO0", kRx), 1u << 31);
  b.set("PADS_BANK0", 4 + 4 * 12 + kClear, 1u << 6);  // no input buffer
  b.set("PIO0", kInstr, in(0, 1));
  b.set("PIO0", kInstr, kPush);
  EXPECT_EQ(b.get("PIO0", kRx), 0u);
}

TEST(Rp2040Pio, JumpsCountDownAndAlwaysWriteTheirRegister) {
  PioBench b;
  b.program({put(kX, 3), jmp(1, 2), mov(6, kX), kPush, jmp(4)});
  b.start();
  b.system.run_for(4);
  EXPECT_EQ(b.get("PIO0", kAddr), 1u);
  b.system.run_for(20);
  EXPECT_EQ(b.get("PIO0", kRx), 0xFFFFFFFFu) << "one below zero";
}

TEST(Rp2040Pio, MovInvertsAndReverses) {
  PioBench b;
  b.program({put(kX, 5), mov(6, kX, 1), kPush, mov(6, kX, 2), kPush, jmp(5)});
  b.start();
  b.system.run_for(20);
  EXPECT_EQ(b.get("PIO0", kRx), ~5u);
  EXPECT_EQ(b.get("PIO0", kRx), 0xA0000000u);
}

TEST(Rp2040Pio, OfTwoMachinesThatWriteAPinInOneCycleTheHigherWins) {
  PioBench b;
  b.drives(3);
  b.set("PIO0", kPins0 + 2 * kNext, 1u << 26 | 3u << 5);
  b.program({put(kPinsOf, 0), jmp(1)});
  b.set("PIO0", kMemory + 4 * 8, put(kPinsOf, 1));
  b.set("PIO0", kMemory + 4 * 9, jmp(9));
  b.set("PIO0", kInstr + 2 * kNext, jmp(8));
  b.start(5);
  b.system.run_for(20);
  EXPECT_TRUE(b.pins().level(3));
}

TEST(Rp2040Pio, RestartTakesTheDelayThatIsLeft) {
  PioBench b;
  b.drives(3);
  b.set("PIO0", kClkdiv, 4u << 16);
  b.program({put(kPinsOf, 1) | delay(31), put(kPinsOf, 0), jmp(2)});
  b.start();
  b.system.run_for(10);
  b.set("PIO0", kCtrl, 1 | 1u << 4);
  b.system.run_for(300);
  ASSERT_EQ(b.edges.size(), 2u);
  EXPECT_EQ((b.edges[1].first - b.edges[0].first) % 4, 0u) << "its divider goes on";
  EXPECT_LE(b.edges[1].first, 10u + 4u);
}

}  // namespace
}  // namespace omnihil::mcu
