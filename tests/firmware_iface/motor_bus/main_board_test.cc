// What a main board says to the boards that drive wheels, byte by byte, and that the other end of the same file
// understands it.
#include <numbers>
#include <set>

#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

std::vector<BusFrame> said(std::string_view dialect, int board, const std::vector<double>& speeds_rad_s) {
  std::vector<BusFrame> frames;
  find_dialect(dialect)->main_board.speak(board, speeds_rad_s, frames);
  return frames;
}
std::vector<std::uint8_t> bytes_of(const BusFrame& frame) {
  return {frame.bytes().begin(), frame.bytes().end()};
}

TEST(MainBoardTest, dialects_are_unique_and_their_periods_fit_the_coupling) {
  std::set<std::string_view> dialects;
  for (const MotorBusKind* kind : motor_buses()) {
    const MainBoard& board = kind->main_board;
    if (board.speak == nullptr) continue;
    EXPECT_TRUE(dialects.insert(board.dialect).second) << board.dialect;
    EXPECT_EQ(find_dialect(board.dialect), kind);
    EXPECT_NE(board.period_ns, 0) << board.dialect;
    EXPECT_EQ(board.period_ns % 500'000, 0) << board.dialect;
  }
  EXPECT_EQ(dialects, (std::set<std::string_view>{"ateam-stspin-2025", "ibis-orion-can"}));
  EXPECT_EQ(find_dialect("no such dialect"), nullptr);
  EXPECT_EQ(find_dialect(""), nullptr) << "a bus whose main board nobody needs";
}

TEST(MainBoardTest, ateam_says_the_motors_speed_in_one_packet) {
  const std::vector<BusFrame> frames = said("ateam-stspin-2025", 3, {100.0});
  ASSERT_EQ(frames.size(), 1u);
  std::vector<std::uint8_t> expected(52);
  expected[0] = 0x21;                        // motion
  expected[8] = 0x02;                        // telemetry on
  expected[12] = 0x01;                       // velocity
  expected[18] = 0xC8, expected[19] = 0x42;  // 100.0f
  EXPECT_EQ(bytes_of(frames[0]), expected);
}

TEST(MainBoardTest, ibis_says_each_motors_revolutions_under_its_own_id) {
  const double turn_rad_s = 2.0 * std::numbers::pi;
  const std::vector<BusFrame> frames = said("ibis-orion-can", 1, {turn_rad_s, -5 * turn_rad_s});
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].id, 0x102u);
  EXPECT_EQ(frames[1].id, 0x103u);
  EXPECT_FALSE(frames[0].extended || frames[0].fd);
  EXPECT_EQ(bytes_of(frames[0]), (std::vector<std::uint8_t>{0, 0, 0x80, 0x3F, 0, 0, 0, 0}));  // 1.0f
  EXPECT_EQ(bytes_of(frames[1]), (std::vector<std::uint8_t>{0, 0, 0xA0, 0xC0, 0, 0, 0, 0}));  // -5.0f
}

TEST(MainBoardTest, what_the_main_board_says_the_motors_take) {
  for (const MotorBusKind* kind : motor_buses()) {
    if (kind->main_board.speak == nullptr) continue;
    BusRig rig(kind->id);
    const int boards = kind->carrier == BusCarrier::kUart ? kWheels : kWheels / 2;
    const std::vector<double> speeds_rad_s(static_cast<std::size_t>(kWheels / boards), 20.0);
    for (int board = 0; board < boards; ++board) {
      for (const BusFrame& f : said(kind->main_board.dialect, board, speeds_rad_s)) rig.send(f);
    }
    rig.run_ms(1);
    EXPECT_EQ(rig.count(BusVerdict::kOk), std::uint64_t{kWheels}) << kind->id;
  }
}

}  // namespace
}  // namespace omnihil::test
