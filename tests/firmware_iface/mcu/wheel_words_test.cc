// What a main board says to its wheels' boards, as tables of the board file.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>

#include "firmware_iface/mcu/stm32/can.h"
#include "tests/firmware_iface/mcu/boards_for_tests.h"

namespace omnihil::mcu {
namespace {

const std::string kHead = kTwoMotorBoard + "[wheel_commands]\n";

// The built-in dialects, as the docs have them.
const std::string kIbis = R"(via = "CAN1"
period_ms = 2

[[wheel_commands.frame]]
id = 0x100
bytes = 8

[[wheel_commands.frame.field]]
at = 0
type = "f32"
per_rad_s = 0.15915494309189535
)";

const std::string kAteam = R"(via = "USART1"
period_ms = 10

[[wheel_commands.frame]]
bytes = 52

[[wheel_commands.frame.field]]
at = 0
type = "u8"
value = 0x21

[[wheel_commands.frame.field]]
at = 8
type = "u32"
value = 2

[[wheel_commands.frame.field]]
at = 12
type = "u8"
value = 1

[[wheel_commands.frame.field]]
at = 16
type = "f32"
per_rad_s = 1.0
)";

std::optional<BoardSpec> read(const std::string& rest, std::vector<BoardProblem>& problems) {
  return read_board(kHead + rest, "b.toml", problems);
}

WheelWords words_of(const std::string& rest) {
  std::vector<BoardProblem> problems;
  const auto spec = read(rest, problems);
  for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
  return spec ? spec->wheel_commands.words : WheelWords{};
}

void expect_same(const WheelWords& words, std::string_view dialect, std::size_t wheels_per_board) {
  const MainBoard& built_in = find_dialect(dialect)->main_board;
  EXPECT_EQ(words.period_ns, built_in.period_ns);
  for (const double scale : {0.0, 1.0, -37.3, 800.0}) {
    const std::array<double, 4> speeds{scale, -0.5 * scale, 3.1 * scale, 0.01 * scale};
    for (std::size_t board = 0; board * wheels_per_board < speeds.size(); ++board) {
      const std::size_t first = board * wheels_per_board;
      const auto own = std::span(speeds).subspan(first, wheels_per_board);
      std::vector<BusFrame> expected, said;
      built_in.speak(static_cast<int>(board), own, expected);
      speak(words, static_cast<int>(board), static_cast<int>(first), own, said);
      ASSERT_EQ(said.size(), expected.size());
      for (std::size_t i = 0; i < said.size(); ++i) {
        EXPECT_EQ(said[i].id, expected[i].id);
        EXPECT_EQ(said[i].size, expected[i].size);
        EXPECT_EQ(said[i].data, expected[i].data) << scale << ", board " << board;
      }
    }
  }
}

TEST(WheelWords, TablesOfTheBuiltInDialectsSayTheSameBytes) {
  expect_same(words_of(kIbis), "ibis-orion-can", 2);
  expect_same(words_of(kAteam), "ateam-stspin-2025", 1);
}

// rpm in 16 bits, the most significant first, both wheels in one frame of a board: 1 rad/s is 60 / (2 pi) rpm.
TEST(WheelWords, AFrameForABoardHasEachWheelWhereItStandsAndEndsAtItsBounds) {
  const WheelWords words = words_of(R"(via = "CAN1"
period_ms = 5

[[wheel_commands.frame]]
each = "board"
id = 0x12340
extended = true
bytes = 6
field = [
  { at = 0, type = "i16", big_endian = true, per_rad_s = 9.549296585513721, wheel = 1 },
  { at = 2, type = "i16", per_rad_s = 9.549296585513721, wheel = 0 },
  { at = 5, type = "u8", value = 7 },
]
)");
  std::vector<BusFrame> said;
  const std::array<double, 2> speeds{-10.0, 1e6};  // -95.49 rpm is -95
  speak(words, 1, 2, speeds, said);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].id, 0x12341u);
  EXPECT_TRUE(said[0].extended);
  EXPECT_EQ(said[0].size, 6);
  const std::array<std::uint8_t, 6> bytes{0x7F, 0xFF, 0xA1, 0xFF, 0, 7};
  for (std::size_t i = 0; i < bytes.size(); ++i) EXPECT_EQ(said[0].data[i], bytes[i]) << i;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(WheelWords, NamesWhatIsWrongInATable) {
  const char* const kCases[][3] = {
      {"at = 0", "at = 5", "wheel_commands.frame[0].field[0].at"},
      {"\"f32\"", "\"f16\"", "wheel_commands.frame[0].field[0].type"},
      {"per_rad_s = 0.15915494309189535", "", "wheel_commands.frame[0].field[0]"},
      {"per_rad_s", "wheel = 1\nper_rad_s", "wheel_commands.frame[0].field[0].wheel"},
      {"per_rad_s", "value = 1\nper_rad_s", "wheel_commands.frame[0].field[0].value"},
      {"type = \"f32\"\nper_rad_s = 0.15915494309189535", "type = \"u8\"\nvalue = 256",
       "wheel_commands.frame[0].field[0].value"},
      {"bytes = 8", "bytes = 9", "wheel_commands.frame[0].bytes"},
      {"id = 0x100", "id = 0x7FE", "wheel_commands.frame[0].id"},
      {"id = 0x100", "", "wheel_commands.frame[0].id"},
      {"period_ms = 2", "", "wheel_commands.period_ms"},
      {"\"CAN1\"", "\"CAN7\"", "wheel_commands.via"},
      {"period_ms = 2", "period_ms = 2\ndialect = \"ibis-orion-can\"", "wheel_commands.dialect"}};
  for (const auto& [from, to, key] : kCases) {
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(read(with(kIbis, from, to), problems)) << to;
    ASSERT_FALSE(problems.empty()) << to;
    EXPECT_NE(problems[0].text().find(key), std::string::npos) << problems[0].text();
  }
}

// A speed of 7 rad/s behind a gear of 3 is 21 of the motor, here its backward, every 2 ms.
TEST(WheelWords, TheMainBoardSaysThemByTheBoardsCan) {
  OMNIHIL_NEED_IMAGES();
  const auto firmware = wheels_firmware(
      "[wheel_commands]\nvia = \"CAN1\"\nreversed = true\nperiod_ms = 2\n"
      "frame = [{ id = 0x100, bytes = 2, field = [{ at = 0, type = \"i16\", per_rad_s = 1 }] }]\n");
  ASSERT_NE(firmware, nullptr);
  std::vector<CanFrame> heard;
  firmware->board().chip().find<CanPort>("CAN1")->watch_frames(
      [&heard](const CanPass& pass) { heard.push_back(pass.frame); });
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_WHEEL_SPEED;
  command.omega_wheel_rad_s[0] = 7.0;
  firmware->command(command, 0);
  RobotSensors sensors{};
  for (int tick = 1; tick <= 20; ++tick) {
    sensors.now_us += 500;
    firmware->tick(sensors);
  }
  EXPECT_EQ(firmware->commands_ignored(), 0u);
  ASSERT_EQ(heard.size(), 5u);
  for (const CanFrame& frame : heard) {
    EXPECT_EQ(frame.id, 0x100u);
    EXPECT_EQ(frame.bytes, 2);
    EXPECT_EQ(static_cast<std::int16_t>(frame.data[0] | frame.data[1] << 8), -21);
  }
}

}  // namespace
}  // namespace omnihil::mcu
