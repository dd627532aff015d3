// Ports of emulated boards: what a board file may say, and clients at them (board_ports_client.py beside this file).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/stm32/can.h"
#include "hil/firmware/console_text.h"
#include "hil/firmware/image_firmware.h"
#include "tests/hil/serve/script_outcome.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", a_serial_port_is_a_terminal_both_ways)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", a_socket_carries_a_flood_at_the_line_rate)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", can_frames_come_and_go)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", a_motor_turns_as_its_can_is_told)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", what_it_says_is_in_the_report_and_on_the_terminal)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", what_is_typed_is_heard_by_the_robots_named)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", what_it_says_is_in_the_recording)

struct BoardPortFiles : CliTest {
  void SetUp() override {
    CliTest::SetUp();
    if (!std::filesystem::exists(OMNIHIL_BUILD_DIR "/images/ports.elf")) GTEST_SKIP() << "no image";
  }
  // What is said of a board file with these lines behind it.
  Ran with(const std::string& lines, const std::string& robots = "0") const {
    const auto board =
        std::filesystem::temp_directory_path() / ("omnihil-port-" + std::to_string(::getpid()) + ".toml");
    std::ofstream(board) << text_of(OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml") << lines;
    const auto device =
        std::filesystem::temp_directory_path() / ("omnihil-port-" + std::to_string(::getpid()));
    const Ran ran = run_omnihil("serve --clock free --duration 0.01 --physics planar --robots " + robots +
                                " --device" + shell(device) +
                                "--firmware '" OMNIHIL_BUILD_DIR "/images/ports.elf' --board" + shell(board));
    std::filesystem::remove(board);
    return ran;
  }
};

TEST_F(BoardPortFiles, MistakesAreNamedByFileAndLine) {
  const Ran ran = with(
      "\n[[port]]\nof = \"USART9\"\nas = \"pty:./x\"\n[[port]]\nof = \"USART1\"\nas = "
      "\"pty:./y\"\n[[port]]\nof = \"CAN1\"\n"
      "console = true\n[[port]]\nof = \"USART3\"\n");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("port[0].of = 'USART9'") && ran.says("semihosting, ITM, RTT")) << ran.text;
  EXPECT_TRUE(ran.says("port[1].of") && ran.says("commands come in by it")) << ran.text;
  EXPECT_TRUE(ran.says("port[2].console")) << ran.text;
  EXPECT_TRUE(ran.says("port[3].as") && ran.says("pty:./console")) << ran.text;
}

TEST_F(BoardPortFiles, WiresThatThereAreNotAreNamedWithThoseThatThereAre) {
  const std::size_t lines_before = [] {
    const std::string text = text_of(OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml");
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }();
  const Ran ran =
      with("[[port]]\nof = \"USART2\"\nas = \"teletype:x\"\n[[port]]\nof = \"CAN1\"\nas = \"pty:./bytes\"\n");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("teletype") && ran.says("pty:")) << ran.text;
  EXPECT_TRUE(ran.says(".toml:" + std::to_string(lines_before + 3))) << ran.text;
  EXPECT_TRUE(ran.says("port[1].as")) << ran.text;
}

// Two boards of one robot on a CAN of their own: each answers with the next id, so one frame goes to and fro for good. Every
// frame arrives at the other a coupling period after it has left, and at nobody else.
TEST_F(BoardPortFiles, BoardsOfARobotShareACan) {
  const auto board =
      std::filesystem::temp_directory_path() / ("omnihil-bus-" + std::to_string(::getpid()) + ".toml");
  std::ofstream(board) << "format = \"omnihil-board/1\"\nname = \"two on a bus\"\nchip = \"stm32f405\"\n"
                          "boards_per_robot = 2\n"
                          "[[motor]]\nwheel = 0\npwm = \"TIM1.1\"\ndirection = \"PE0\"\n"
                          "[[motor]]\nwheel = 1\npwm = \"TIM1.2\"\ndirection = \"PE1\"\n"
                          "[[port]]\nof = \"CAN1\"\nas = \"bus:wheels\"\n"
                          "[[port]]\nof = \"semihosting\"\n";
  struct Frame {
    std::uint32_t id;
    std::uint8_t byte;
    std::int64_t at_ns;
  };
  std::vector<Frame> sent[2], come[2];
  std::vector<mcu::CanPort*> cans;
  const auto listen = [&](const MadeBoard& made) {
    mcu::McuBoard& mcu = made.mcu;
    cans.push_back(mcu.chip().find<mcu::CanPort>("CAN1"));
    cans.back()->watch_frames([&, at = static_cast<std::size_t>(made.board)](const mcu::CanPass& pass) {
      (pass.sent ? sent : come)[at].push_back(
          {pass.frame.id, pass.frame.data[0], mcu.machine().to_ns(pass.end)});
    });
  };
  const auto maker =
      image_firmware(OMNIHIL_BUILD_DIR "/images/ports.elf", board.string(), {}, {.on_board = listen});
  RobotConfig config{};
  config.gear_ratio = 1.0;
  config.encoder_counts_per_rotor_turn = 4096;
  const std::unique_ptr<Firmware> firmware = maker(config);
  ASSERT_EQ(cans.size(), 2u);
  for (int tick = 0; tick < 60; ++tick) {
    if (tick == 10) cans[0]->receive({.id = 0x200, .bytes = 1, .data = {7}});
    RobotSensors sensors{};
    sensors.now_us = static_cast<std::uint64_t>(500 * tick);
    firmware->tick(sensors);
  }
  ASSERT_GT(sent[0].size(), 10u);
  ASSERT_GT(sent[1].size(), 10u);
  for (std::size_t i = 0; i + 1 < sent[0].size(); ++i) {
    EXPECT_EQ(sent[0][i].id, 0x201u + 2 * i);
    EXPECT_EQ(come[1][i].id, sent[0][i].id);
    EXPECT_EQ(come[1][i].byte, sent[0][i].byte);
    EXPECT_NEAR(static_cast<double>(come[1][i].at_ns - sent[0][i].at_ns), 500'000.0, 1'000.0);
    EXPECT_EQ(sent[1][i].id, 0x202u + 2 * i);
    EXPECT_EQ(come[0][i + 1].id, sent[1][i].id);  // the first one came from outside
  }
  const std::vector<std::string> report = firmware->report();
  EXPECT_TRUE(std::ranges::any_of(report, [](const std::string& line) {
    return line.find("CAN1 on bus wheels of 2 boards") != std::string::npos;
  }));
  std::filesystem::remove(board);
}

TEST_F(BoardPortFiles, ABusIsACanOfSeveralBoardsAndHasAName) {
  const Ran ran = with("[[port]]\nof = \"USART2\"\nas = \"bus:\"\n");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("a bus without a name")) << ran.text;
  EXPECT_TRUE(ran.says("a bus between boards is a CAN")) << ran.text;
  EXPECT_TRUE(ran.says("boards_per_robot = 2 or more")) << ran.text;
}

TEST(ConsoleText, BytesBecomeLinesOfWhichTheLastAreKept) {
  std::vector<std::string> heard;
  ConsoleText text([&](const std::string& line) { heard.push_back(line); });
  text.add("ab\x01");
  text.add("c\r\nd");
  EXPECT_EQ(heard, (std::vector<std::string>{"ab.c"}));
  EXPECT_EQ(text.lines(), (std::vector<std::string>{"ab.c", "d"}));
  for (int i = 0; i < 100; ++i) text.add("\n");
  EXPECT_EQ(text.count(), 101u);
  EXPECT_EQ(text.lines().size(), ConsoleText::kLines);
}

}  // namespace
}  // namespace omnihil
