// The CORDIC unit against closed forms, to the precision that RM0440 states after so many iterations.
#include "firmware_iface/mcu/stm32/math/cordic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

constexpr double kPi = std::numbers::pi;

struct CordicBench : ChipBench {
  CordicBench() : ChipBench("stm32g474") {}
  static std::uint32_t word(double value) {
    return static_cast<std::uint32_t>(
        static_cast<std::int64_t>(std::clamp(value * 0x1p31, -0x1p31, 0x1p31 - 1)));
  }
  static double number(std::uint32_t word) { return static_cast<std::int32_t>(word) * 0x1p-31; }
  void configure(unsigned function, unsigned precision, unsigned scale, bool two_arguments,
                 bool two_results) {
    set("CORDIC", 0,
        function | precision << 4 | scale << 8 | (two_results ? 1u << 19 : 0u) |
            (two_arguments ? 1u << 20 : 0u));
  }
  CordicPair work(unsigned function, unsigned precision, unsigned scale, double first, double second) {
    configure(function, precision, scale, true, true);
    set("CORDIC", 4, word(first));
    set("CORDIC", 4, word(second));
    system.run_for(64);
    const double a = number(get("CORDIC", 8));
    return {a, number(get("CORDIC", 8))};
  }
};

// RM0440 table 109: the largest error after 4, 8, … 24 iterations of a rotation.
constexpr double kResidual[] = {0x1p-3, 0x1p-7, 0x1p-11, 0x1p-15, 0x1p-18, 0x1p-19};

TEST(CordicUnit, SineAndCosineOfEveryAngleAndModulus) {
  CordicBench b;
  for (unsigned precision = 1; precision <= 6; ++precision) {
    double worst = 0.0;
    for (double turns = -0.999; turns < 1.0; turns += 0.037) {
      for (const double modulus : {1.0, 0.7, 0.1}) {
        const CordicPair p = b.work(0, precision, 0, turns, modulus);
        worst = std::max(worst, std::abs(p.first - modulus * std::cos(turns * kPi)));
        worst = std::max(worst, std::abs(p.second - modulus * std::sin(turns * kPi)));
        const CordicPair q = b.work(1, precision, 0, turns, modulus);
        EXPECT_EQ(q.first, p.second);
        EXPECT_EQ(q.second, p.first);
      }
    }
    EXPECT_LE(worst, kResidual[precision - 1]) << precision;
    if (precision < 5) {
      EXPECT_GT(worst, kResidual[precision]) << "fewer iterations, a larger error";
    }
  }
}

TEST(CordicUnit, PhaseAndModulusInAllFourQuadrants) {
  CordicBench b;
  for (double angle = -3.1; angle <= 3.1; angle += 0.1) {
    const double x = 0.6 * std::cos(angle), y = 0.6 * std::sin(angle);
    const CordicPair p = b.work(2, 6, 0, x, y);
    EXPECT_NEAR(p.first, angle / kPi, 0x1p-19);
    EXPECT_NEAR(p.second, 0.6, 0x1p-19);
    const CordicPair q = b.work(3, 6, 0, x, y);
    EXPECT_NEAR(q.first, 0.6, 0x1p-19);
    EXPECT_NEAR(q.second, angle / kPi, 0x1p-19);
  }
}

struct Scalar {
  const char* name;
  unsigned function;
  std::vector<std::pair<unsigned, std::pair<double, double>>> ranges;  // of x, by scale
  std::function<double(double x, double unscale)> value;               // unscale: 2^-n
};

TEST(CordicUnit, FunctionsOfOneNumberOverTheirRanges) {
  const Scalar rows[] = {
      {"arctangent",
       4,
       {{0, {-1, 1}}, {3, {-8, 8}}, {7, {-128, 128}}},
       [](double x, double u) { return u * std::atan(x) / kPi; }},
      {"cosh", 5, {{1, {-1.118, 1.118}}}, [](double x, double u) { return u * std::cosh(x); }},
      {"sinh", 6, {{1, {-1.118, 1.118}}}, [](double x, double u) { return u * std::sinh(x); }},
      {"atanh", 7, {{1, {-0.806, 0.806}}}, [](double x, double u) { return u * std::atanh(x); }},
      {"ln",
       8,
       {{1, {0.107, 1.0}}, {2, {1.0, 3.0}}, {4, {3.0, 9.35}}},
       [](double x, double u) { return u * 0.5 * std::log(x); }},
      {"sqrt", 9, {{0, {0.027, 0.75}}, {1, {0.75, 1.75}}, {2, {1.75, 2.341}}}, [](double x, double u) {
         return u * std::sqrt(x);
       }}};
  CordicBench b;
  for (const Scalar& row : rows) {
    for (const auto& [scale, range] : row.ranges) {
      const double unscale = std::ldexp(1.0, -static_cast<int>(scale));
      for (int i = 1; i < 40; ++i) {
        const double x = range.first + (range.second - range.first) * i / 40.0;
        EXPECT_NEAR(b.work(row.function, 6, scale, x * unscale, 1.0).first, row.value(x, unscale), 0x1p-18)
            << row.name << " of " << x;
      }
    }
  }
}

// A root has twice as many places per iteration: 2^-7, 2^-14, 2^-19 after 4, 8, 12.
TEST(CordicUnit, ARootNeedsHalfOfTheIterations) {
  CordicBench b;
  for (const auto& [precision, bound] : {std::pair{1u, 0x1p-7}, {2u, 0x1p-14}, {3u, 0x1p-19}}) {
    for (double x = 0.05; x < 0.75; x += 0.05) {
      EXPECT_NEAR(b.work(9, precision, 0, x, 1.0).first, std::sqrt(x), bound) << precision << " " << x;
    }
  }
}

TEST(CordicUnit, AResultTakesItsCyclesAndAsks) {
  CordicBench b;
  EXPECT_EQ(b.get("CORDIC", 0), 0x50u);
  b.set("CORDIC", 0, 6u << 4 | 1u << 16);
  b.set("CORDIC", 4, CordicBench::word(0.25));
  b.system.run_for(5);
  EXPECT_EQ(b.get("CORDIC", 0) >> 31, 0u);
  EXPECT_FALSE(b.system.irq_high[100]);
  b.system.run_for(1);
  EXPECT_EQ(b.get("CORDIC", 0) >> 31, 1u);
  EXPECT_TRUE(b.system.irq_high[100]);
  EXPECT_NEAR(CordicBench::number(b.get("CORDIC", 8)), std::cos(kPi / 4), 0x1p-19)
      << "the modulus is 1 after reset";
  EXPECT_EQ(b.get("CORDIC", 0) >> 31, 0u);
  EXPECT_FALSE(b.system.irq_high[100]);
}

TEST(CordicUnit, HalfWordsHoldBothArgumentsAndBothResults) {
  CordicBench b;
  b.set("CORDIC", 0, 6u << 4 | 1u << 19 | 1u << 21 | 1u << 22);
  b.set("CORDIC", 4, 0x7FFF0000u | 0x2AAAu);  // modulus 1, a third of half a turn
  b.system.run_for(10);
  const std::uint32_t both = b.get("CORDIC", 8);
  EXPECT_NEAR(static_cast<std::int16_t>(both) * 0x1p-15, std::cos(kPi / 3), 0x1p-14);
  EXPECT_NEAR(static_cast<std::int16_t>(both >> 16) * 0x1p-15, std::sin(kPi / 3), 0x1p-14);
  EXPECT_EQ(b.get("CORDIC", 0) >> 31, 0u) << "one read has both";
}

TEST(CordicUnit, TheNextArgumentWaitsUntilTheResultIsRead) {
  CordicBench b;
  b.configure(0, 6, 0, false, false);
  b.set("CORDIC", 4, CordicBench::word(0.0));
  b.system.run_for(10);
  b.set("CORDIC", 4, CordicBench::word(0.5));
  b.system.run_for(10);
  EXPECT_NEAR(CordicBench::number(b.get("CORDIC", 8)), 1.0, 0x1p-19);
  b.system.run_for(10);
  EXPECT_NEAR(CordicBench::number(b.get("CORDIC", 8)), 0.0, 0x1p-19);
}

TEST(CordicUnit, AReservedFunctionIsReported) {
  CordicBench b;
  b.set("CORDIC", 0, 6u << 4 | 12);
  b.set("CORDIC", 4, 0);
  EXPECT_EQ(b.system.unmodelled.count("CORDIC: CSR: a function that is reserved"), 1u);
}

TEST(LowPowerUart, ABitTakesBrrTwoHundredFiftySixthsOfAClock) {
  ChipBench b("stm32g474");
  b.set("LPUART1", 0x0C, 256 * 100 + 128);  // 100.5 clocks; whole cycles of the core: 100
  b.set("LPUART1", 0x00, 1 | 1u << 3);
  std::vector<Cycles> ends;
  b.chip.find<Usart>("LPUART1")->on_transmit([&](std::uint8_t byte, Cycles end) {
    EXPECT_EQ(byte, 0x5A);
    ends.push_back(end);
  });
  const Cycles start = b.system.now();
  b.set("LPUART1", 0x28, 0x5A);
  b.system.run_for(2000);
  ASSERT_EQ(ends.size(), 1u);
  EXPECT_EQ(ends[0] - start, 1000u);
  EXPECT_EQ(b.get("LPUART1", 0x0C), 256u * 100 + 128) << "twenty bits";
}

}  // namespace
}  // namespace omnihil::mcu
