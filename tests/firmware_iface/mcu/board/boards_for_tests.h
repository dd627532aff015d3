// Board files that several tests begin with, and the image of the wheels behind one of them.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {

// Two motors a board, two boards a robot.
inline const std::string kTwoMotorBoard = R"(format = "omnihil-board/1"
name = "test"
chip = "STM32F303RB"
boards_per_robot = 2

[[motor]]
wheel = 0
pwm = ["TIM1.1", "TIM1.2", "TIM1.3"]

[[motor]]
wheel = 1
pwm = ["TIM8.1", "TIM8.2", "TIM8.3"]

)";

// The test image "wheels" on a board with one motor and `more` in its file; null: the test has failed.
inline std::unique_ptr<McuFirmware> wheels_firmware(const std::string& more) {
  std::vector<BoardProblem> problems;
  const auto spec = read_board(
      "format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"stm32f405\"\n[[motor]]\nwheel = 0\npwm = "
      "\"TIM1.1\"\ndirection = \"PE0\"\n" +
          more,
      "b.toml", problems);
  for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
  ElfImage image;
  std::vector<std::string> wrong;
  const bool read = read_elf(image_bytes("wheels"), image, wrong);
  EXPECT_TRUE(read);
  if (!spec || !read) return nullptr;
  RobotConfig config{};
  config.gear_ratio = 3.0;
  config.wheel_radius_m = 0.027;
  config.encoder_counts_per_rotor_turn = 4096.0;
  config.bus_voltage_nominal_V = 24.0;
  return std::make_unique<McuFirmware>(*spec, image, config);
}

}  // namespace omnihil::mcu
