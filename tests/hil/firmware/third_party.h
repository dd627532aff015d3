// Images that none of us wrote: built elsewhere from public sources, named by OMNIHIL_IMAGES (a folder), and
// what their boards answered when the same images ran in another emulator (OMNIHIL_SHARED).
//
//   class AteamWheel : public ThirdPartyImage { … ThirdPartyImage("ateam-wheel.elf", "ateam_wheel_f031.toml")
//   };
//
// docs/mcu-third-party.md says which files these are.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "hil/firmware/image_files.h"
#include "protocols/radio_format.h"

namespace omnihil {

inline std::string third_party_image(const std::string& name) {
  const char* folder = std::getenv("OMNIHIL_IMAGES");
  if (folder == nullptr) return "";
  const std::string path = std::string(folder) + "/" + name;
  return std::ifstream(path) ? path : "";
}

inline std::string third_party_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string third_party_vectors(const std::string& name) {
  const char* folder = std::getenv("OMNIHIL_SHARED");
  if (folder == nullptr) return "";
  const std::string path = std::string(folder) + "/vectors/" + name;
  return std::ifstream(path) ? path : "";
}

template <typename T>
T from_bytes(std::span<const std::uint8_t> bytes, std::size_t at) {
  T value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

template <typename T>
void put_bytes(std::span<std::uint8_t> bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

// What the host writes to its dongle.
inline std::vector<std::uint8_t> host_packet(std::string_view radio, std::string_view name,
                                             const std::vector<std::pair<std::string, double>>& fields) {
  const RadioFormat* format = find_radio_format(radio);
  Values values;
  values.message = format->find(name);
  for (const auto& [field, value] : fields) values.set(field, value);
  std::vector<std::uint8_t> bytes;
  EXPECT_EQ(format->encode(values, bytes).error, PacketError::kNone) << name;
  return bytes;
}

inline std::vector<std::uint8_t> hermes_packet(  // for robot 0
    std::string_view name, std::vector<std::pair<std::string, double>> fields = {}) {
  fields.emplace_back("robot", 0);
  return host_packet("ulaval-hermes", name, fields);
}

inline std::vector<std::uint8_t> rem_command(int robot, double v_forward_m_s, double v_left_m_s,
                                             double omega_rad_s, bool state = false) {
  return host_packet("roboteam-rem-v8", "REM_RobotCommand",
                     {{"toRobotId", robot},
                      {"toColor", 1},
                      {"fromPC", 1},
                      {"rho", std::hypot(v_forward_m_s, v_left_m_s)},
                      {"theta", std::atan2(v_left_m_s, v_forward_m_s)},
                      {"angularVelocity", omega_rad_s},
                      {"sendStateInfo", state ? 1 : 0}});
}

class ThirdPartyImage : public testing::Test {
 protected:
  ThirdPartyImage(std::string image, std::string board)
      : image_file_(std::move(image)), board_file_(OMNIHIL_SOURCE_DIR "/boards/" + board) {}

  void SetUp() override {
    const std::string path = third_party_image(image_file_);
    if (path.empty()) GTEST_SKIP() << "OMNIHIL_IMAGES names no folder with " << image_file_;
    const std::string bytes = third_party_text(path);
    std::vector<std::string> problems;
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    ASSERT_TRUE(mcu::read_elf(std::span(data, bytes.size()), elf_, problems)) << problems[0];
    std::vector<mcu::BoardProblem> wrong;
    spec_ = mcu::read_board(third_party_text(board_file_), board_file_, wrong, board_context(board_file_));
    for (const mcu::BoardProblem& problem : wrong) ADD_FAILURE() << problem.text();
    ASSERT_TRUE(spec_);
  }
  std::unique_ptr<mcu::McuBoard> board() const { return std::make_unique<mcu::McuBoard>(*spec_, elf_); }
  std::uint32_t word(mcu::McuBoard& board, std::string_view symbol, unsigned offset = 0) const {
    const auto address = elf_.address_of(symbol);
    if (!address) {
      ADD_FAILURE() << "no symbol " << symbol;
      return 0;
    }
    std::uint8_t raw[4] = {};
    board.machine().memory().read(*address + offset, raw);
    return raw[0] | raw[1] << 8 | raw[2] << 16 | static_cast<std::uint32_t>(raw[3]) << 24;
  }
  // A register as the image would read it.
  static std::uint32_t peek(mcu::McuBoard& board, std::string_view block, std::uint32_t offset) {
    for (const auto& at : board.chip().blocks()) {
      if (at.peripheral->name() == block) return at.peripheral->read(offset, 4);
    }
    ADD_FAILURE() << "no " << block;
    return 0;
  }
  std::vector<std::string> report(const mcu::McuBoard& board) const { return mcu::board_report(board, elf_); }

  std::string image_file_, board_file_;
  mcu::ElfImage elf_;
  std::optional<mcu::BoardSpec> spec_;
};

}  // namespace omnihil
