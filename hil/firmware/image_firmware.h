// An unmodified microcontroller image and its board file, read and checked, as a session takes them.
//
//   Session session(config, image_firmware("wheels.elf", "boards/mine.toml"));
//
// Each robot gets a board of its own with the same image. Throws std::invalid_argument with every problem of
// both files, a line each; the maker does if the image does not fit the chip's memory.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "firmware_iface/mcu/board/board.h"
#include "hil/firmware/board_ports.h"
#include "hil/firmware/image_observer.h"
#include "hil/loop/session.h"

namespace omnihil {

// A board that a robot has just been given, before it runs; of its session's life.
struct MadeBoard {
  std::uint32_t robot_id;
  int board, boards;  // of its robot, and how many it has
  mcu::McuBoard& mcu;
  const mcu::ElfImage& image;
};
using BoardListener = std::function<void(const MadeBoard&)>;

struct ImageListeners {
  BoardListener on_board = {};
  ConsoleListener on_line = {};
  ConsoleInput typed = {};
  bool ports = true;  // false: nothing leads out: ports are not opened, cards not written
};

// `served`: the radio format that the session serves, which the board's must be; empty: any that there is.
Session::FirmwareMaker image_firmware(const std::string& image_file, const std::string& board_file,
                                      std::string_view served = {}, ImageListeners listeners = {},
                                      std::shared_ptr<ImageObserver> observer = nullptr);

}  // namespace omnihil
