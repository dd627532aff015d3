// Ports of emulated boards: what a board file may say, and clients at them (board_ports_client.py beside this file).
#include <gtest/gtest.h>

#include <fstream>

#include "firmware_iface/mcu/board/board_spec.h"
#include "hil/firmware/console_text.h"
#include "tests/hil/serve/script_outcome.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", a_serial_port_is_a_terminal_both_ways)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", a_socket_carries_a_flood_at_the_line_rate)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", can_frames_come_and_go)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", a_motor_turns_as_its_can_is_told)
SCRIPT_TEST(BoardPorts, "firmware/board_ports_client.py", what_it_says_is_in_the_report_and_on_the_terminal)

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
  EXPECT_TRUE(ran.says("port[0].of = 'USART9'") && ran.says("semihosting, ITM")) << ran.text;
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
