// [wheel_commands] of a board file: a dialect from a file of its own, or the main board's frames as tables.
#pragma once
#include <toml++/toml.h>

#include "firmware_iface/mcu/board/board_keys.h"
#include "firmware_iface/mcu/board/board_names.h"
#include "firmware_iface/mcu/board/board_spec.h"

namespace omnihil::mcu {

// Of the board that is read: its motors, and the coupling period that a main board's own is a multiple of.
struct CommandedBoard {
  int motors;
  std::int64_t coupling_ns;
};

// `names`: of the chip; null where it is not known.
WheelCommands read_wheel_commands(const toml::table& top, BoardKeys& keys, const BoardNames* names,
                                  const CommandedBoard& board, const FindDialect& find);

// A dialect's file, for a board of so many motors: words, and whether they are a serial port's.
struct Dialect {
  WheelWords words;
  bool serial = false;
};
std::optional<Dialect> read_dialect(const DialectFile& file, int motors, std::vector<BoardProblem>& problems);

}  // namespace omnihil::mcu
