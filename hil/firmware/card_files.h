// Files behind the memory cards of emulated boards: read as a run begins, replaced whole at its end where they may be written.
//
//   CardFiles cards("robot.toml", 3, std::make_shared<CardWriters>());
//   mcu::McuFirmware mcu(spec, elf, robot, [&cards](const auto& entry, int board) { return cards.open(entry, board); });
//   cards.save(mcu);
//
// A path is seen from the board file's folder. Without `writable` what a card takes is kept for the run alone. With it the
// changed card is written beside its file and takes the file's name, so that at any instant the file is the old or the new
// one. One board alone may have a file that it writes.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/board/mcu_firmware.h"

namespace omnihil {

// Who writes which file: robot and board by path, of all robots of one firmware.
using CardWriters = std::map<std::string, std::pair<std::uint32_t, int>>;

class CardFiles {
 public:
  // `writers`: null: whatever the board file says, no file is written.
  CardFiles(std::string board_file, std::uint32_t robot_id, std::shared_ptr<CardWriters> writers)
      : board_file_(std::move(board_file)), robot_id_(robot_id), writers_(std::move(writers)) {}
  // Throws std::invalid_argument naming board file and device.
  mcu::CardImage open(const mcu::DeviceEntry& entry, int board);
  // Of each card that may be written and has changed; the problems, with the file's name.
  std::vector<std::string> save(const mcu::McuFirmware& firmware) const;

 private:
  struct Open {
    std::string path, device;
    int board;
  };
  std::string board_file_;
  std::uint32_t robot_id_;
  std::shared_ptr<CardWriters> writers_;
  std::vector<Open> writable_;
};

}  // namespace omnihil
