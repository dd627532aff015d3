// The image of the four wheels, compiled for other chips, drives the simulated robot as it does on an STM32F405.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "hil/firmware/image_firmware.h"
#include "hil/recording/session_setup.h"
#include "tests/hil/one_robot.h"

namespace omnihil {
namespace {
constexpr double kRotor_rad_s = 60.0;  // in the board file's preset flash

struct Other {
  const char *chip, *image;
  std::size_t wheels = 4;
};

class OtherChips : public testing::TestWithParam<Other> {
 protected:
  static std::string image() { return std::string(OMNIHIL_BUILD_DIR "/images/") + GetParam().image + ".elf"; }
  // The F405's board file with another chip's name in it: the image has its motors on the same timers and pins.
  static std::string board_text() {
    std::ifstream file(OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    text.replace(text.find("\"stm32f405\""), 11, std::string("\"") + GetParam().chip + "\"");
    // Of a chip with fewer timers for encoders: without the last motors, which coast.
    std::size_t end = text.find("[[motor]]");
    for (std::size_t i = 0; i < GetParam().wheels; ++i) end = text.find("[[motor]]", end + 1);
    if (end != std::string::npos) text.erase(end, text.find("\n\n[[", text.rfind("[[motor]]")) - end);
    return text;
  }
  void SetUp() override {
    if (!std::filesystem::exists(image())) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
  }
};

TEST_P(OtherChips, WheelsReachTheirSpeedsWithinOnePercentAndNothingIsUnmodelled) {
  const auto board = std::filesystem::temp_directory_path() /
                     ("omnihil-other-" + std::to_string(::getpid()) + GetParam().chip + ".toml");
  std::ofstream(board) << board_text();
  SessionSetup setup = test::one_robot("omni_default");
  setup.step_ns = 1'000'000;
  Session session(session_config(setup), image_firmware(image(), board.string()));
  std::filesystem::remove(board);
  std::vector<std::uint8_t> out;
  while (session.now_ns() < 1'500'000'000) session.step({}, out);
  for (std::size_t i = 0; i < GetParam().wheels; ++i)
    EXPECT_NEAR(session.plant().truth(0).omega_rotor_rad_s[i], kRotor_rad_s, 0.01 * kRotor_rad_s) << i;
  for (const std::string& line : session.firmware(0).report()) EXPECT_EQ(line, "");
}

INSTANTIATE_TEST_SUITE_P(Chips, OtherChips,
                         testing::Values(Other{"stm32f103ze", "wheels_f103"},
                                         Other{"stm32h743", "wheels_h743"}, Other{"stm32l476", "wheels_l476"},
                                         Other{"stm32g0b1", "wheels_g0b1", 3}),
                         [](const auto& row) { return std::string(row.param.chip); });

}  // namespace
}  // namespace omnihil
