// [wheel_commands] of a board file: a dialect that is built in, or the main board's frames as tables.
#pragma once
#include <toml++/toml.h>

#include "firmware_iface/mcu/board/board_keys.h"
#include "firmware_iface/mcu/board/board_names.h"
#include "firmware_iface/mcu/board/board_spec.h"

namespace omnihil::mcu {

// `names`: of the chip; null where it is not known.
WheelCommands read_wheel_commands(const toml::table& top, BoardKeys& keys, const BoardNames* names,
                                  int motors);

}  // namespace omnihil::mcu
