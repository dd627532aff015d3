// The MA7xx's angle word and registers, as its data sheet (MA730 rev. 1.01) has them.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/firmware_iface/mcu/device_bench.h"

namespace omnihil::mcu {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

TEST(Ma7xx, GivesFourteenBitsAtTheTopOfTheWord) {
  DeviceBench b("ma7xx");
  for (const unsigned step : {0u, 1u, 4096u, 8191u, 16383u}) {
    b.angle_rad = kTurn_rad * ((step + 0.5) / 16384.0 + 2.0);
    EXPECT_EQ(b.word(0), step << 2) << step;
  }
  b.angle_rad = -0.25 * kTurn_rad + 1e-9;
  EXPECT_EQ(b.word(0), 0xC000u);
}

TEST(Ma7xx, TakesTheAngleAsItIsSelected) {
  DeviceBench b("ma7xx");
  b.angle_rad = 0.5 * kTurn_rad + 1e-9;
  b.device->spi()->select(true);
  const unsigned high = b.device->spi()->exchange(0);
  b.angle_rad = 0.0;
  const unsigned low = b.device->spi()->exchange(0);
  b.device->spi()->select(false);
  EXPECT_EQ(high << 8 | low, 0x8000u);
}

TEST(Ma7xx, ReadsAndWritesRegistersOneFrameLate) {
  DeviceBench b("ma7xx");
  b.angle_rad = 0.5 * kTurn_rad + 1e-9;
  EXPECT_EQ(b.word(0x8000 | 1u << 8 | 0x40), 0x8000u) << "still the angle";
  EXPECT_EQ(b.word(0), 0x4000u) << "the register written, in the high byte";
  EXPECT_EQ(b.word(0x4000 | 1u << 8), 0x4000u) << "the angle, less the zero of 0x4000";
  EXPECT_EQ(b.word(0), 0x4000u) << "the register read";
  EXPECT_EQ(b.word(0x4000 | 27u << 8), 0x4000u);
  EXPECT_EQ(b.word(0), 0u) << "magnet: neither too weak nor too strong";
}

TEST(Ma7xx, TurnsRoundByItsRegisterAndByItsSetting) {
  DeviceBench b("ma7xx");
  b.word(0x8000 | 9u << 8 | 0x80);
  b.word(0);
  b.angle_rad = 0.25 * kTurn_rad - 1e-9;
  EXPECT_EQ(b.word(0), 0xC000u);
  DeviceBench c("ma7xx", {{"direction", -1.0}, {"offset_rad", std::numbers::pi}, {"bits", 12.0}});
  c.angle_rad = 0.25 * kTurn_rad - 1e-9;
  EXPECT_EQ(c.word(0), 0x4000u);
  c.angle_rad = 0.25 * kTurn_rad - kTurn_rad / 8192.0;  // half of a step of twelve bits
  EXPECT_EQ(c.word(0), 0x4000u);
}

}  // namespace
}  // namespace omnihil::mcu
