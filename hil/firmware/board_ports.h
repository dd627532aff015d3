// Serial ports and CANs of an emulated board that lead out of the bench, and consoles: [[port]] of its file.
//
//   BoardPorts ports(board, {.robot_id = 3, .board_file = "mine.toml"});    // opens the wires; throws std::invalid_argument
//   ports.pump();                                 // before every run of the board
//   ports.report();                               // a line each
//
// Both ways: what the board has sent since the last pump goes out, what has come in is given to it at its own rate
// (bytes one frame time after the other, at most kFramesAtOnce CAN frames a pump, so that its FIFO holds them). What
// nobody takes is counted. Bytes of a console are kept as lines of text, whole ones told to a listener at once. A run
// with a wire from outside is as repeatable as what comes in by it. Cannot: noise, flow control.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "firmware_iface/mcu/board/board_problem.h"
#include "hil/firmware/board_bus.h"

namespace omnihil {

using ConsoleListener =
    std::function<void(std::uint32_t robot_id, int board, const std::string& port, const std::string& line)>;

// All that has been typed at this robot's consoles since the start; it only grows. A port with `console` that takes bytes is
// given it as if by a wire.
using ConsoleInput = std::function<std::string_view(std::uint32_t robot_id)>;

struct BoardPortsOptions {
  std::uint32_t robot_id = 0;
  int board = 0;           // of the robot
  std::string board_file;  // in messages
  ConsoleListener on_line = {};
  ConsoleInput typed = {};
  BoardBuses* buses = nullptr;  // of the robot; needed where a port is on one
};

// What is wrong with the wires that a board file names, as far as words tell.
std::vector<mcu::BoardProblem> port_problems(const mcu::BoardSpec& spec, const std::string& board_file);

class BoardPorts {
 public:
  static constexpr int kFramesAtOnce = 2;

  BoardPorts(mcu::McuBoard& board, const BoardPortsOptions& options);
  ~BoardPorts();
  void pump();
  std::vector<std::string> report() const;

 private:
  struct Port;
  struct WireEnd;
  struct Typed;
  struct SerialPort;
  struct CanLine;
  struct TextSource;
  struct RttSource;
  struct BusLine;
  std::vector<std::unique_ptr<Port>> ports_;
};

}  // namespace omnihil
