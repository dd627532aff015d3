// The frames of a main board as tables (motor_bus/wheel_words.h), in a board file or in the file of a dialect.
#pragma once
#include <toml++/toml.h>

#include "firmware_iface/mcu/board/board_keys.h"
#include "firmware_iface/motor_bus/wheel_words.h"

namespace omnihil::mcu {

// `path`: of the table in its file, "wheel_commands", or empty. `motors`: of the board.
WheelWords read_wheel_words(const toml::table& t, const std::string& path, BoardKeys& keys, bool serial,
                            int motors);

}  // namespace omnihil::mcu
