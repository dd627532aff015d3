// Images with damage, and what the program says of files that do not go together.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/mcu_firmware.h"

namespace omnihil::mcu {
namespace {
const std::string kImage = OMNIHIL_BUILD_DIR "/images/wheels.elf";

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

RobotConfig some_robot() {
  RobotConfig config{};
  config.gear_ratio = 3.0;
  config.encoder_counts_per_rotor_turn = 4096;
  config.bus_voltage_nominal_V = 22.2;
  return config;
}

TEST(SlowDamagedImages, AThousandOfThemEitherRunOrAreRefused) {
  if (!std::filesystem::exists(kImage)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
  std::vector<BoardProblem> problems;
  const auto board =
      read_board(file_text(OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml"), "board", problems);
  ASSERT_TRUE(board);
  const std::string good = file_text(kImage);
  std::mt19937 random(99);
  int refused = 0, stopped = 0, ran = 0;
  for (int i = 0; i < 1000; ++i) {
    std::string bytes = good;
    // Mostly in the code, so that most of them run; some in the headers.
    for (unsigned n = 0; n < 1 + random() % 30; ++n) {
      const std::size_t at = random() % 4 == 0 ? random() % 256 : random() % bytes.size();
      bytes[at] = static_cast<char>(random());
    }
    ElfImage image;
    std::vector<std::string> why;
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    if (!read_elf({data, bytes.size()}, image, why)) {
      ++refused;
      EXPECT_FALSE(why.empty());
      continue;
    }
    try {
      McuFirmware firmware(*board, image, some_robot());
      RobotSensors sensors{};
      for (int tick = 0; tick < 4; ++tick) {
        sensors.now_us = static_cast<std::uint64_t>(tick) * 500;
        const RobotDrive drive = firmware.tick(sensors);
        for (const double duty : drive.duty_ratio) EXPECT_LE(std::abs(duty), 1.0);
      }
      EXPECT_GE(firmware.board().now_ns(), 2'000'000);
      board_report(firmware.board(), image);
      (firmware.board().machine().stopped() ? stopped : ran)++;
    } catch (const std::invalid_argument& error) {
      ++refused;
      EXPECT_FALSE(std::string(error.what()).empty());
    }
  }
  EXPECT_GT(ran, 100);
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace omnihil::mcu
