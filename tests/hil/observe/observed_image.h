// The reference image on its board, run by itself for a while: standing shafts, a full battery, no radio.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "hil/loop/model_store.h"
#include "hil/loop/session_checks.h"

namespace omnihil {

inline std::string bytes_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline const std::string kReferenceImage = OMNIHIL_BUILD_DIR "/images/omni_reference_f405.elf";

class ObservedImage {
 public:
  explicit ObservedImage(const std::string& image = kReferenceImage) {
    const std::string board_file = OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml";
    const std::string text = bytes_text(image);
    std::vector<std::string> problems;
    mcu::read_elf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, elf, problems);
    EXPECT_EQ(problems, std::vector<std::string>{});
    std::vector<mcu::BoardProblem> board_problems;
    const auto board = mcu::read_board(bytes_text(board_file), board_file, board_problems, {});
    EXPECT_TRUE(board.has_value());
    const StoredModel stored = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"});
    firmware = std::make_unique<mcu::McuFirmware>(*board, elf, robot_config(*stored.model->robot, 0));
  }

  void run_ms(int ms) {
    double theta_rad = 0.0;
    turn_ms(ms, 0.0, theta_rad);
  }
  // All shafts turn evenly, from `theta_rad` on, which follows.
  void turn_ms(int ms, double omega_rad_s, double& theta_rad) {
    const std::int64_t end_ns = now_ns_ + std::int64_t{ms} * 1'000'000;
    for (; now_ns_ < end_ns; now_ns_ += firmware->control_period_ns()) {
      RobotSensors sensors{};
      RobotShafts shafts{};
      mcu::WorldState world{};
      for (std::size_t w = 0; w < kWheels; ++w) {
        world.theta_rotor_rad[w] = shafts.theta_rotor_rad[w] = theta_rad;
        shafts.omega_rotor_rad_s[w] = omega_rad_s;
        sensors.encoder_counts[w] = world.encoder_counts(static_cast<int>(w), 0);
      }
      sensors.now_us = static_cast<std::uint64_t>(now_ns_ / 1000);
      sensors.bus_voltage_V = 24.0;
      firmware->shafts(shafts);
      firmware->tick(sensors);
      theta_rad += omega_rad_s * 1e-9 * static_cast<double>(firmware->control_period_ns());
    }
  }
  mcu::Machine& machine() { return firmware->board(0).machine(); }

  mcu::ElfImage elf;
  std::unique_ptr<mcu::McuFirmware> firmware;

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace omnihil
