// Divider and interpolators of the RP2040 against §2.3.1 of its datasheet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware_iface/mcu/rp2040/interpolator.h"
#include "tests/firmware_iface/mcu/rp2040/rp2040_bench.h"

namespace omnihil::mcu {
namespace {
// By zero: -1, of a negative dividend 1, the remainder is the dividend.
TEST(Rp2040Divider, ItsCornersAreThoseOfTheChip) {
  Rp2040Bench b;
  constexpr auto kLeast = std::numeric_limits<std::int32_t>::min();
  struct Row {
    std::int32_t a, b, quotient, remainder;
  };
  for (const Row row : {Row{kLeast, -1, kLeast, 0},
                        {kLeast, 1, kLeast, 0},
                        {kLeast, kLeast, 1, 0},
                        {7, -2, -3, 1},
                        {-7, 2, -3, -1},
                        {-7, -2, 3, -1},
                        {0, 0, -1, 0},
                        {5, 0, -1, 5},
                        {-5, 0, 1, -5},
                        {kLeast, 0, 1, kLeast}}) {
    b.set("SIO", 0x68, static_cast<std::uint32_t>(row.a));
    b.set("SIO", 0x6C, static_cast<std::uint32_t>(row.b));
    EXPECT_EQ(b.get("SIO", 0x78), 3u) << "ready, dirty";
    EXPECT_EQ(static_cast<std::int32_t>(b.get("SIO", 0x74)), row.remainder) << row.a << "/" << row.b;
    EXPECT_EQ(static_cast<std::int32_t>(b.get("SIO", 0x70)), row.quotient) << row.a << "/" << row.b;
    EXPECT_EQ(b.get("SIO", 0x78), 1u) << "clean, the quotient was read";
  }
  b.set("SIO", 0x60, 0xFFFFFFFF);
  b.set("SIO", 0x64, 2);
  EXPECT_EQ(b.get("SIO", 0x74), 1u);
  EXPECT_EQ(b.get("SIO", 0x70), 0x7FFFFFFFu);
  b.set("SIO", 0x70, 12);  // an interrupt's end puts back what it found
  b.set("SIO", 0x74, 34);
  EXPECT_EQ(b.get("SIO", 0x74), 34u);
  EXPECT_EQ(b.get("SIO", 0x70), 12u);
}

enum : std::uint32_t {
  kAccumulator = 0x00,
  kBase = 0x08,
  kPop = 0x14,
  kPeek = 0x20,
  kControl = 0x2C,
  kAdd = 0x34,
  kBases = 0x3C
};
constexpr std::uint32_t lane(std::uint32_t shift, std::uint32_t low, std::uint32_t high) {
  return shift | low << 5 | high << 10;
}

// The times table of §2.3.1.6: each pop adds the base.
TEST(Rp2040Interpolator, PoppingALaneAddsItsBase) {
  Interpolator i(0);
  i.write(kControl, lane(0, 0, 31));
  i.write(kAccumulator, 0);
  i.write(kBase, 12);
  for (std::uint32_t k = 1; k < 10; ++k) EXPECT_EQ(i.read(kPop, true), 12 * k);
  EXPECT_EQ(i.read(kPeek, false), 120u);
  EXPECT_EQ(i.read(kPeek, false), 120u);
}

TEST(Rp2040Interpolator, ALaneShiftsMasksAndExtendsItsSign) {
  Interpolator i(0);
  i.write(kControl, lane(8, 4, 11) | 1u << 15);
  i.write(kAccumulator, 0x000ABC00);  // >> 8: 0xABC, & 0xFF0: 0xAB0
  EXPECT_EQ(i.read(kAdd, false), 0xFFFFFAB0u);
  i.write(kBase, 0x550);
  EXPECT_EQ(i.read(kPeek, false), 0u);
  EXPECT_EQ(i.read(kControl, false) >> 23 & 7, 0u);
  i.write(kAccumulator, 0x100ABC00);
  EXPECT_EQ(i.read(kControl, false) >> 23 & 7, 5u) << "bits above the mask";
  i.write(kAdd, 0x400);
  EXPECT_EQ(i.read(kAccumulator, false), 0x100AC000u);
}

TEST(Rp2040Interpolator, LanesCrossTheirInputsAndResults) {
  Interpolator i(0);
  i.write(kControl, lane(0, 0, 31) | 1u << 17);
  i.write(kControl + 4, lane(4, 0, 31) | 1u << 16);
  i.write(kAccumulator, 0x120);
  i.write(kAccumulator + 4, 0x999);
  i.write(kBase, 1);
  i.write(kBase + 4, 2);
  i.write(kBase + 8, 0x1000);
  EXPECT_EQ(i.read(kPeek + 8, false), 0x1000u + 0x120 + 0x12);
  EXPECT_EQ(i.read(kPop, true), 0x121u);
  EXPECT_EQ(i.read(kAccumulator, false), 0x14u) << "lane 1's result";
  EXPECT_EQ(i.read(kAccumulator + 4, false), 0x14u);
}

// BASE0 + alpha (BASE1 - BASE0) / 256.
TEST(Rp2040Interpolator, BlendsBetweenItsBases) {
  Interpolator i(0);
  i.write(kControl, 1u << 21 | lane(0, 0, 31));
  for (const bool with_sign : {false, true}) {
    i.write(kControl + 4, lane(0, 0, 31) | (with_sign ? 1u << 15 : 0u));
    const std::int64_t from = with_sign ? -1000 : 500, to = with_sign ? 1000 : 1500;
    i.write(kBase, static_cast<std::uint32_t>(from));
    i.write(kBase + 4, static_cast<std::uint32_t>(to));
    for (std::int64_t alpha = 0; alpha < 256; alpha += 51) {
      i.write(kAccumulator + 4, static_cast<std::uint32_t>(alpha));
      const double exact = static_cast<double>(from) + static_cast<double>(alpha * (to - from)) / 256;
      EXPECT_EQ(static_cast<std::int32_t>(i.read(kPeek + 4, false)), std::floor(exact)) << alpha;
      EXPECT_EQ(i.read(kPeek, false), alpha);
    }
  }
}

TEST(Rp2040Interpolator, ClampsBetweenItsBases) {
  Interpolator i(1);
  i.write(kControl, 1u << 22 | lane(2, 0, 29) | 1u << 15);
  i.write(kBase, 0);
  i.write(kBase + 4, 255);
  for (const int x : {-1024, -4, 0, 4, 1020, 1024, 100'000}) {
    i.write(kAccumulator, static_cast<std::uint32_t>(x));
    EXPECT_EQ(static_cast<int>(i.read(kPeek, false)), std::clamp(x >> 2, 0, 255)) << x;
  }
}

TEST(Rp2040Interpolator, BothBasesAreWrittenByHalves) {
  Interpolator i(0);
  i.write(kControl, lane(0, 0, 31) | 1u << 15);
  i.write(kBases, 0x8001FFFE);
  EXPECT_EQ(i.read(kBase, false), 0xFFFFFFFEu);
  EXPECT_EQ(i.read(kBase + 4, false), 0x8001u) << "without a sign";
}

// FORCE_MSB is on the bus alone.
TEST(Rp2040Interpolator, ForcedBitsAreNotInTheAccumulator) {
  Interpolator i(0);
  i.write(kControl, lane(0, 0, 31) | 2u << 19);
  i.write(kBase, 4);
  EXPECT_EQ(i.read(kPop, true), 0x20000004u);
  EXPECT_EQ(i.read(kPop, true), 0x20000008u);
  EXPECT_EQ(i.read(kAccumulator, false), 8u);
}

}  // namespace
}  // namespace omnihil::mcu
