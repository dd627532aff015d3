// What main boards say to wheel boards, byte by byte.
#include "firmware_iface/mcu/board/wheel_dialect.h"

#include <gtest/gtest.h>

#include <set>

namespace omnihil::mcu {
namespace {

TEST(WheelDialect, NamesAreUniqueAndPeriodsFitTheCoupling) {
  std::set<std::string_view> names;
  for (const WheelDialect* dialect : all_wheel_dialects()) {
    EXPECT_TRUE(names.insert(dialect->name).second) << dialect->name;
    EXPECT_EQ(find_wheel_dialect(dialect->name), dialect);
    EXPECT_GT(dialect->period_ns, 0) << dialect->name;
    EXPECT_EQ(dialect->period_ns % 500'000, 0) << dialect->name;
  }
  EXPECT_EQ(find_wheel_dialect("no such dialect"), nullptr);
}

TEST(WheelDialect, AteamSaysTheMotorsSpeedInOnePacket) {
  WheelWords words;
  const std::vector<double> speed_rad_s = {100.0};
  find_wheel_dialect("ateam-stspin-2025")->speak(3, speed_rad_s, words);
  EXPECT_TRUE(words.can.empty());
  std::vector<std::uint8_t> expected(52);
  expected[0] = 0x21;                        // motion
  expected[8] = 0x02;                        // telemetry on
  expected[12] = 0x01;                       // velocity
  expected[18] = 0xC8, expected[19] = 0x42;  // 100.0f
  EXPECT_EQ(words.serial, expected);
}

TEST(WheelDialect, IbisSaysEachMotorsRevolutionsUnderItsOwnId) {
  WheelWords words;
  const double turn_rad_s = 6.283185307179586;
  const std::vector<double> speed_rad_s = {turn_rad_s, -5 * turn_rad_s};
  find_wheel_dialect("ibis-orion-can")->speak(1, speed_rad_s, words);
  EXPECT_TRUE(words.serial.empty());
  ASSERT_EQ(words.can.size(), 2u);
  CanFrame first, second;
  first.id = 0x102;
  second.id = 0x103;
  first.bytes = second.bytes = 8;
  first.data = {0x00, 0x00, 0x80, 0x3F};   // 1.0f
  second.data = {0x00, 0x00, 0xA0, 0xC0};  // -5.0f
  EXPECT_EQ(words.can[0], first);
  EXPECT_EQ(words.can[1], second);
}

}  // namespace
}  // namespace omnihil::mcu
