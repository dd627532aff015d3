// The FPU's own rules: NaNs, halves, roundings, saturation. Expected bits are the manual's.
#include "firmware_iface/mcu/core/fp.h"

#include <gtest/gtest.h>

#include <bit>
#include <cfenv>
#include <cmath>
#include <limits>

namespace omnihil::mcu {
namespace {

std::uint32_t raw(float value) { return std::bit_cast<std::uint32_t>(value); }
float from(std::uint32_t bits) { return std::bit_cast<float>(bits); }

class HostRounding {
 public:
  explicit HostRounding(int mode) { std::fesetround(mode); }
  ~HostRounding() { std::fesetround(FE_TONEAREST); }
};

TEST(FpTest, SignallingNanBeforeQuietAndFirstBeforeSecond) {
  const float quiet = from(0x7FC00001), signalling = from(0x7F800002), other = from(0xFFC00003);
  EXPECT_EQ(raw(fp_nan(quiet, signalling, 0)), 0x7FC00002u);
  EXPECT_EQ(raw(fp_nan(quiet, other, 0)), 0x7FC00001u);
  EXPECT_EQ(raw(fp_nan(1.0f, other, 0)), 0xFFC00003u);
  EXPECT_EQ(raw(fp_nan(1.0f, 2.0f, 0)), 0x7FC00000u);  // infinity - infinity and the like
  EXPECT_EQ(raw(fp_nan(quiet, other, kDefaultNan)), 0x7FC00000u);
}

TEST(FpTest, RoundingToAnIntegerKeepsTheSignWhateverTheHostRoundsTo) {
  for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    const HostRounding host(mode);
    for (const FpRounding rounding : {kTiesAway, kTiesEven, kUp, kDown, kToZero}) {
      EXPECT_FALSE(std::signbit(fp_round(0.25, rounding, 0))) << mode << " " << rounding;
      EXPECT_TRUE(std::signbit(fp_round(-0.25, rounding, 0))) << mode << " " << rounding;
      EXPECT_TRUE(std::signbit(fp_round(-0.0f, rounding, 0))) << mode << " " << rounding;
    }
    EXPECT_EQ(fp_round(2.5, kTiesEven, 0), 2.0);
    EXPECT_EQ(fp_round(3.5, kTiesEven, 0), 4.0);
    EXPECT_EQ(fp_round(-2.5, kTiesAway, 0), -3.0);
    EXPECT_EQ(fp_round(2.1f, kUp, 0), 3.0f);
    EXPECT_EQ(fp_round(-2.1f, kDown, 0), -3.0f);
  }
}

TEST(FpTest, FixedPointBecomesTheNearestNumberInAnyMode) {
  constexpr double kBetween = 16777217.0;  // 2^24 + 1: halfway, to even
  for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD}) {
    const HostRounding host(mode);
    EXPECT_EQ(fp_nearest(kBetween), 16777216.0f) << mode;
    EXPECT_EQ(fp_nearest(kBetween + 2), 16777220.0f) << mode;
  }
}

TEST(FpTest, IntegersSaturateAndNanIsZero) {
  EXPECT_EQ(fp_to_int(3e9, false, 32, kToZero), 0x7FFFFFFFu);
  EXPECT_EQ(fp_to_int(-3e9, false, 32, kToZero), 0x80000000u);
  EXPECT_EQ(fp_to_int(-1.5, true, 32, kToZero), 0u);
  EXPECT_EQ(fp_to_int(5e9, true, 32, kToZero), 0xFFFFFFFFu);
  EXPECT_EQ(fp_to_int(-40000.0, false, 16, kToZero), static_cast<std::uint32_t>(-32768));
  EXPECT_EQ(fp_to_int(std::numeric_limits<double>::quiet_NaN(), false, 32, kToZero), 0u);
}

TEST(FpTest, EveryHalfComesBackFromItsValue) {
  for (std::uint32_t half = 0; half < 0x10000; ++half) {
    const bool nan = (half & 0x7C00) == 0x7C00 && (half & 0x3FF) != 0;
    const std::uint16_t bits = static_cast<std::uint16_t>(half);
    EXPECT_EQ(fp_to_half(fp_from_half(bits, 0), 0), nan ? half | 0x200 : half);
  }
}

TEST(FpTest, HalvesRoundToEvenAndOverflowToInfinity) {
  EXPECT_EQ(fp_to_half(1.0 + std::ldexp(1.0, -11), 0), 0x3C00);      // halfway to the next
  EXPECT_EQ(fp_to_half(1.0 + 3 * std::ldexp(1.0, -11), 0), 0x3C02);  // halfway, odd below
  EXPECT_EQ(fp_to_half(65519.0, 0), 0x7BFF);
  EXPECT_EQ(fp_to_half(65520.0, 0), 0x7C00);
  EXPECT_EQ(fp_to_half(std::ldexp(1.0, -25), 0), 0);
  EXPECT_EQ(fp_to_half(std::ldexp(1.5, -25), 0), 1);
}

TEST(FpTest, MaximumPrefersANumberAndPlusZero) {
  const float quiet = from(0x7FC00001);
  EXPECT_EQ(fp_max(1.0f, quiet, 0), 1.0f);
  EXPECT_EQ(fp_min(quiet, 2.0f, 0), 2.0f);
  EXPECT_FALSE(std::signbit(fp_max(-0.0f, 0.0f, 0)));
  EXPECT_TRUE(std::signbit(fp_min(0.0f, -0.0f, 0)));
}

TEST(FpTest, DenormalsFlushToZerosOfTheirSign) {
  EXPECT_EQ(raw(fp_flush(from(0x80000001))), 0x80000000u);
  EXPECT_EQ(raw(fp_flush(from(0x00800000))), 0x00800000u);
}

}  // namespace
}  // namespace omnihil::mcu
