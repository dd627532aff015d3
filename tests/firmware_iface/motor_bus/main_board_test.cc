// What main boards say to the boards that drive wheels, byte by byte, and that the devices on the same wire
// understand it.
#include <numbers>

#include "tests/firmware_iface/mcu/board/dialects_for_tests.h"
#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

std::vector<BusFrame> said(const std::string& dialect, int board, const std::vector<double>& speeds_rad_s) {
  const auto motors = static_cast<int>(speeds_rad_s.size());
  std::vector<BusFrame> frames;
  speak(mcu::dialect_words(dialect, motors), {board, board * motors, 0}, speeds_rad_s, frames);
  return frames;
}
std::vector<std::uint8_t> bytes_of(const BusFrame& frame) {
  return {frame.bytes().begin(), frame.bytes().end()};
}

TEST(MainBoardTest, ateam_says_the_motors_speed_in_one_packet_every_10_ms) {
  const std::vector<BusFrame> frames = said("ateam-stspin-2025", 3, {100.0});
  ASSERT_EQ(frames.size(), 1u);
  std::vector<std::uint8_t> expected(52);
  expected[0] = 0x21;                        // motion
  expected[8] = 0x02;                        // telemetry on
  expected[12] = 0x01;                       // velocity
  expected[18] = 0xC8, expected[19] = 0x42;  // 100.0f
  EXPECT_EQ(bytes_of(frames[0]), expected);
  EXPECT_EQ(mcu::dialect_words("ateam-stspin-2025", 1).period_ns, 10'000'000);
}

TEST(MainBoardTest, ibis_says_each_motors_revolutions_under_its_own_id_every_2_ms) {
  const double turn_rad_s = 2.0 * std::numbers::pi;
  const std::vector<BusFrame> frames = said("ibis-orion-can", 1, {turn_rad_s, -5 * turn_rad_s});
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].id, 0x102u);
  EXPECT_EQ(frames[1].id, 0x103u);
  EXPECT_FALSE(frames[0].extended || frames[0].fd);
  EXPECT_EQ(bytes_of(frames[0]), (std::vector<std::uint8_t>{0, 0, 0x80, 0x3F, 0, 0, 0, 0}));  // 1.0f
  EXPECT_EQ(bytes_of(frames[1]), (std::vector<std::uint8_t>{0, 0, 0xA0, 0xC0, 0, 0, 0, 0}));  // -5.0f
  EXPECT_EQ(mcu::dialect_words("ibis-orion-can", 2).period_ns, 2'000'000);
}

TEST(MainBoardTest, what_the_main_board_says_the_motors_take) {
  const struct {
    const char *dialect, *bus;
    int boards;
  } kRows[] = {{"ateam-stspin-2025", "ateam-uart-2025", kWheels},
               {"ibis-orion-can", "ibis-orion", kWheels / 2}};
  for (const auto& row : kRows) {
    BusRig rig(row.bus);
    const std::vector<double> speeds_rad_s(static_cast<std::size_t>(kWheels / row.boards), 20.0);
    for (int board = 0; board < row.boards; ++board) {
      for (BusFrame f : said(row.dialect, board, speeds_rad_s)) {
        if (row.boards == kWheels) f.id = static_cast<std::uint32_t>(board);  // a line each
        rig.send(f);
      }
    }
    rig.run_ms(1);
    EXPECT_EQ(rig.count(BusVerdict::kOk), std::uint64_t{kWheels}) << row.bus;
  }
}

}  // namespace
}  // namespace omnihil::test
