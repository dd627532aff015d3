// A program's terminal in RAM, led out of the bench by a wire.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "hil/firmware/board_ports.h"
#include "hil/firmware/rtt_console.h"

namespace omnihil {
namespace {

struct RttPort : testing::Test {
  void SetUp() override {
    std::ifstream file(OMNIHIL_BUILD_DIR "/images/ports.elf", std::ios::binary);
    if (!file) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    std::vector<std::string> wrong;
    ASSERT_TRUE(mcu::read_elf(bytes, elf_, wrong));
  }
  std::unique_ptr<mcu::McuBoard> board(const std::string& port) const {
    std::vector<mcu::BoardProblem> problems;
    const auto spec = mcu::read_board(
        "format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"stm32f405\"\n[[motor]]\nwheel = 0\npwm = "
        "\"TIM1.1\"\ndirection = \"PE0\"\n[[port]]\nof = \"semihosting\"\n" +
            port,
        "b.toml", problems);
    for (const mcu::BoardProblem& p : problems) ADD_FAILURE() << p.text();
    return std::make_unique<mcu::McuBoard>(*spec, elf_);
  }
  mcu::ElfImage elf_;
};

// Its buffers hold 15 and 7 bytes.
TEST_F(RttPort, WhatIsPutIsReadAsThereIsRoom) {
  const auto on = board("");
  on->machine().set_semihosting([](std::string_view) {});
  RttConsole rtt(on->machine());
  const std::string sent = "hello, here are more letters than it has room for";
  std::string heard;
  std::size_t put = 0, most = 0;
  EXPECT_EQ(rtt.room(), 0u) << "there is no control block yet";
  for (int n = 0; n < 400; ++n) {
    on->run_until_ns(on->now_ns() + 500'000);
    rtt.pump([&](std::string_view said) { heard += said; });
    const std::size_t room = std::min(rtt.room(), sent.size() - put);
    most = std::max(most, rtt.room());
    rtt.put({reinterpret_cast<const std::uint8_t*>(sent.data()) + put, room});
    put += room;
  }
  EXPECT_EQ(most, 7u);
  EXPECT_EQ(heard,
            "by rtt, and it is longer than the buffer\nHELLO, HERE ARE MORE LETTERS THAN IT HAS ROOM FOR");
}

TEST_F(RttPort, AWireIsATerminalBothWays) {
  const auto path = std::filesystem::temp_directory_path() / ("omnihil-rtt-" + std::to_string(::getpid()));
  const auto on = board("[[port]]\nof = \"RTT\"\nas = \"pty:" + path.string() + "\"\n");
  BoardPorts ports(*on, {});
  const int terminal = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(::write(terminal, "hello, board", 12), 12);
  std::string heard;
  for (int n = 0; n < 400; ++n) {
    ports.pump();
    on->run_until_ns(on->now_ns() + 500'000);
    char bytes[64];
    const ssize_t count = ::read(terminal, bytes, sizeof bytes);
    if (count > 0) heard.append(bytes, static_cast<std::size_t>(count));
  }
  ::close(terminal);
  EXPECT_NE(heard.find("longer than the buffer"), std::string::npos) << heard;
  EXPECT_NE(heard.find("HELLO, BOARD"), std::string::npos) << heard;
  std::string report;
  for (const std::string& line : ports.report()) report += line + "\n";
  EXPECT_NE(report.find("RTT at pty:"), std::string::npos) << report;
  EXPECT_NE(report.find("12 in"), std::string::npos) << report;
}

// As it comes, and as there is room. A serial port hears it once its receiver is on, as on a line.
TEST_F(RttPort, WhatIsTypedReachesTheConsoles) {
  std::string typed;
  std::vector<std::string> said;
  const auto on = board(
      "console = true\n[[port]]\nof = \"RTT\"\nconsole = true\n[[port]]\nof = \"USART2\"\nconsole = true\n");
  BoardPorts ports(*on, {.robot_id = 3,
                         .board_file = "b.toml",
                         .on_line = [&](std::uint32_t, int, const std::string& port,
                                        const std::string& line) { said.push_back(port + ": " + line); },
                         .typed =
                             [&](std::uint32_t robot) {
                               return robot == 3 ? std::string_view(typed) : std::string_view();
                             }});
  for (int n = 0; n < 800; ++n) {
    if (n == 100) typed += "typed ";
    if (n == 400) typed += "by hand, more than there is room for\n";
    ports.pump();
    on->run_until_ns(on->now_ns() + 500'000);
  }
  const std::string all = "TYPED BY HAND, MORE THAN THERE IS ROOM FOR";
  EXPECT_NE(std::ranges::find(said, "RTT: " + all), said.end()) << testing::PrintToString(said);
  EXPECT_NE(std::ranges::find(said, "USART2: " + all), said.end()) << testing::PrintToString(said);
}

TEST_F(RttPort, TextThatOnlyLeadsOutHasNoWire) {
  std::vector<mcu::BoardProblem> problems;
  mcu::read_board(
      "format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"stm32f405\"\n[[motor]]\nwheel = 0\npwm = "
      "\"TIM1.1\"\ndirection = \"PE0\"\n[[port]]\nof = \"ITM\"\nas = \"pty:./x\"\n",
      "b.toml", problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].text().find("leads out of the board only"), std::string::npos) << problems[0].text();
}

}  // namespace
}  // namespace omnihil
