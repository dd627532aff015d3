// PWM slices and pin interrupts of the RP2040 against the formulas of its datasheet (§4.5, §2.19).
#include <gtest/gtest.h>

#include <vector>

#include "tests/firmware_iface/mcu/rp2040/rp2040_bench.h"

namespace omnihil::mcu {
namespace {
// Of slice n at 0x14 n.
enum : std::uint32_t { kCsr = 0x00, kDiv = 0x04, kCtr = 0x08, kCc = 0x0C, kTop = 0x10, kSlice = 0x14 };
constexpr std::uint32_t kEn = 0xA0, kIntr = 0xA4, kInte = 0xA8, kInts = 0xB0;

// Up to TOP and down to 0, two counts at either end: 2 (TOP + 1) in all, high for 2 CC of them around its 0.
TEST(Rp2040Pwm, PhaseCorrectCountsUpAndDownAndIsHighForTwiceItsCompareValue) {
  Rp2040Bench b;
  constexpr std::uint32_t kTopValue = 9, kCompare = 3, kPeriod = 2 * (kTopValue + 1);
  b.give(0, IoBank::kPwm);
  b.set("PWM", kTop, kTopValue);
  b.set("PWM", kCc, kCompare);
  b.set("PWM", kCsr, 1 | 2);
  unsigned high = 0;
  for (std::uint32_t i = 0; i < 3 * kPeriod; ++i) {
    const std::uint32_t at = i % kPeriod, counter = at <= kTopValue ? at : kPeriod - 1 - at;
    ASSERT_EQ(b.get("PWM", kCtr), counter) << i;
    high += b.slice("PWM0").level(0, false) ? 1 : 0;
    b.system.run_for(1);
  }
  EXPECT_EQ(high, 3 * 2 * kCompare);
  EXPECT_DOUBLE_EQ(b.slice("PWM0").period_s(), kPeriod / 125e6);
  EXPECT_DOUBLE_EQ(b.slice("PWM0").pin(0, false).high_ratio, 2.0 * kCompare / kPeriod);
}

TEST(Rp2040Pwm, PhaseCorrectWrapsOnceInTwiceItsCounts) {
  Rp2040Bench b;
  b.set("PWM", kTop, 99);
  b.set("PWM", kInte, 1);
  b.set("PWM", kCsr, 1 | 2);
  for (int wrap = 0; wrap < 5; ++wrap) {
    b.system.run_for(199);
    EXPECT_FALSE(b.system.irq_high[4]) << wrap;
    b.system.run_for(1);
    EXPECT_TRUE(b.system.irq_high[4]) << wrap;
    b.set("PWM", kIntr, 1);
    EXPECT_FALSE(b.system.irq_high[4]) << wrap;
  }
}

// One count in INT + FRAC / 16 cycles, on the average over any time.
TEST(Rp2040Pwm, TheDividersFractionIsInEveryNumberOfCycles) {
  for (const std::uint32_t div : {0x10u, 0x18u, 0x21u, 0x2Fu, 0x4Bu, 0xFF8u}) {
    Rp2040Bench b;
    b.set("PWM", kDiv, div);
    b.set("PWM", kCsr, 1);
    for (const std::uint32_t cycles : {7u, 40u, 333u, 4096u, 25'000u}) {
      const std::uint32_t before = b.get("PWM", kCtr);
      b.set("PWM", kCtr, 0);
      EXPECT_EQ(b.get("PWM", kCtr), 0u) << before;
      b.system.run_for(cycles);
      EXPECT_EQ(b.get("PWM", kCtr), cycles * 16 / div) << div << " " << cycles;
    }
  }
}

TEST(Rp2040Pwm, AWholePartOfZeroDividesBy256) {
  Rp2040Bench b;
  b.set("PWM", kDiv, 0);
  b.set("PWM", kCsr, 1);
  b.system.run_for(256 * 10 - 1);
  EXPECT_EQ(b.get("PWM", kCtr), 9u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("PWM", kCtr), 10u);
}

TEST(Rp2040Pwm, ACompareValueAboveTopIsAlwaysHighAndZeroNever) {
  Rp2040Bench b;
  b.give(0, IoBank::kPwm);
  b.give(1, IoBank::kPwm);
  b.set("PWM", kTop, 9);
  b.set("PWM", kCc, 10);
  b.set("PWM", kCsr, 1);
  for (int i = 0; i < 20; ++i, b.system.run_for(1)) {
    EXPECT_TRUE(b.slice("PWM0").level(0, false));
    EXPECT_FALSE(b.slice("PWM0").level(1, false));
  }
  EXPECT_EQ(b.slice("PWM0").pin(0, false).high_ratio, 1.0);
  EXPECT_EQ(b.slice("PWM0").pin(1, false).high_ratio, 0.0);
  b.set("PWM", kCsr, 1 | 1u << 2);  // A inverted
  EXPECT_EQ(b.slice("PWM0").pin(0, false).high_ratio, 0.0);
}

TEST(Rp2040Pwm, SlicesOfOneWriteToEnRunInStep) {
  Rp2040Bench b;
  b.set("PWM", kEn, 0xFF);
  b.system.run_for(1234);
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(b.get("PWM", kSlice * i + kCtr), 1234u) << i;
  b.set("PWM", kEn, 0);
  b.system.run_for(100);
  EXPECT_EQ(b.get("PWM", kSlice * 3 + kCtr), 1234u) << "it keeps its count";
}

TEST(Rp2040Pwm, GatedByItsSecondPinItCountsWhileThatIsHigh) {
  Rp2040Bench b;
  b.give(5, IoBank::kPwm);
  b.set("PWM", 2 * kSlice + kDiv, 2u << 4);
  b.set("PWM", 2 * kSlice + kCsr, 1 | 1u << 4);
  b.system.run_for(100);
  EXPECT_EQ(b.get("PWM", 2 * kSlice + kCtr), 0u);
  b.pins().drive(5, true);
  b.system.run_for(100);
  b.pins().drive(5, false);
  b.system.run_for(100);
  EXPECT_EQ(b.get("PWM", 2 * kSlice + kCtr), 50u);
}

TEST(Rp2040Pwm, APinThatIsHighBeforeItIsTheSlicesGatesIt) {
  Rp2040Bench b;
  b.pins().drive(5, true);
  b.set("PWM", 2 * kSlice + kCsr, 1 | 1u << 4);
  b.give(5, IoBank::kPwm);
  b.system.run_for(100);
  EXPECT_EQ(b.get("PWM", 2 * kSlice + kCtr), 100u);
  b.give(5, IoBank::kSio);
  b.system.run_for(100);
  EXPECT_EQ(b.get("PWM", 2 * kSlice + kCtr), 100u) << "given to somebody else: its B is low";
}

// The divider lessens the events of B that are counted, its fraction too.
TEST(Rp2040Pwm, EdgesOfItsSecondPinAreDividedToo) {
  for (const std::uint32_t div : {0x10u, 0x18u, 0x28u, 0x30u}) {
    Rp2040Bench b;
    b.give(5, IoBank::kPwm);
    b.set("PWM", 2 * kSlice + kDiv, div);
    b.set("PWM", 2 * kSlice + kCsr, 1 | 3u << 4);  // falling
    constexpr std::uint32_t kEdges = 60;
    for (std::uint32_t i = 0; i < kEdges; ++i) {
      b.pins().drive(5, true);
      b.pins().drive(5, false);
    }
    EXPECT_EQ(b.get("PWM", 2 * kSlice + kCtr), kEdges * 16 / div) << div;
  }
}

TEST(Rp2040Pwm, CountedEdgesWrapAndInterruptToo) {
  Rp2040Bench b;
  b.give(1, IoBank::kPwm);
  b.set("PWM", kTop, 3);
  b.set("PWM", kInte, 1);
  b.set("PWM", kCsr, 1 | 2u << 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(b.get("PWM", kInts), 0u) << i;
    b.pins().drive(1, true);
    b.pins().drive(1, false);
  }
  EXPECT_EQ(b.get("PWM", kInts), 1u);
  EXPECT_EQ(b.get("PWM", kCtr), 0u);
}

// INTR, INTE, INTF, INTS of eight pins a word: low, high, falling, rising.
constexpr std::uint32_t kPinIntr = 0xF0, kPinInte = 0x100, kPinIntf = 0x110, kPinInts = 0x120;

TEST(Rp2040Pins, AnEdgeIsLatchedUntilItIsClearedWhateverTheLevelIs) {
  Rp2040Bench b;
  constexpr unsigned kPin = 21, kShift = 4 * (kPin % 8);
  b.set("IO_BANK0", kPinInte + 4 * (kPin / 8) + kSet, 8u << kShift);
  b.pins().drive(kPin, true);
  b.pins().drive(kPin, false);
  EXPECT_TRUE(b.system.irq_high[13]);
  EXPECT_EQ(b.get("IO_BANK0", kPinInts + 8) >> kShift & 15, 8u) << "the falling one is not asked for";
  b.set("IO_BANK0", kPinIntr + 8, 4u << kShift);
  EXPECT_TRUE(b.system.irq_high[13]) << "another edge was cleared";
  b.set("IO_BANK0", kPinIntr + 8, 8u << kShift);
  EXPECT_FALSE(b.system.irq_high[13]);
  EXPECT_EQ(b.get("IO_BANK0", kPinIntr + 8) >> kShift & 15, 1u);
}

TEST(Rp2040Pins, ALevelInterruptIsThereAsLongAsItsLevelAndCannotBeCleared) {
  Rp2040Bench b;
  constexpr unsigned kPin = 2, kShift = 4 * kPin;
  b.set("IO_BANK0", kPinInte + kSet, 2u << kShift);
  EXPECT_FALSE(b.system.irq_high[13]);
  b.pins().drive(kPin, true);
  EXPECT_TRUE(b.system.irq_high[13]);
  b.set("IO_BANK0", kPinIntr, 0xFu << kShift);
  EXPECT_TRUE(b.system.irq_high[13]);
  b.pins().drive(kPin, false);
  EXPECT_FALSE(b.system.irq_high[13]);
  b.set("IO_BANK0", kPinIntf, 4u << kShift);
  EXPECT_TRUE(b.system.irq_high[13]) << "forced";
  b.set("IO_BANK0", kPinIntf + kClear, 4u << kShift);
  EXPECT_FALSE(b.system.irq_high[13]);
}

TEST(Rp2040Pins, AnEdgeThatNobodyAskedForIsThereWhenItIsAskedFor) {
  Rp2040Bench b;
  b.pins().drive(9, true);
  EXPECT_FALSE(b.system.irq_high[13]);
  b.set("IO_BANK0", kPinInte + 4, 8u << 4);
  EXPECT_TRUE(b.system.irq_high[13]);
}

TEST(Rp2040Pins, AnInvertedInputRisesWhereItsPadFalls) {
  Rp2040Bench b;
  b.pins().drive(4, true);
  b.set("IO_BANK0", 8 * 4 + 4, IoBank::kSio | 1u << 16);
  EXPECT_EQ(b.get("SIO", 0x04) >> 4 & 1, 0u);
  b.set("IO_BANK0", kPinIntr, 0xFu << 16);
  b.pins().drive(4, false);
  EXPECT_EQ(b.get("IO_BANK0", kPinIntr) >> 16 & 15, 0xAu) << "high, rising";
  EXPECT_EQ(b.get("SIO", 0x04) >> 4 & 1, 1u);
}

// An edge of what the pin's interrupts and SIO see, not only of the pad (§2.19.3: behind the override).
TEST(Rp2040Pins, TurningAnInputRoundIsAnEdge) {
  Rp2040Bench b;
  b.give(4, IoBank::kSio);
  b.set("IO_BANK0", kPinIntr, 0xFu << 16);
  b.set("IO_BANK0", 8 * 4 + 4, IoBank::kSio | 1u << 16);
  EXPECT_EQ(b.get("IO_BANK0", kPinIntr) >> 16 & 15, 0xAu) << "high, rising";
}

}  // namespace
}  // namespace omnihil::mcu
