// The pins of a board's chip as they change: PA5, with what the board file hangs on it (PA5_wheel0_direction).
//
//   watch_pins(board, log, "robot0");              // before it runs; the log outlives it
//
// What a voltmeter at a general-purpose pin would say. A pin that belongs to a timer or a bus is drawn there. Those of the
// board file are always there, others from their first change on.
#pragma once
#include <string>

#include "firmware_iface/mcu/board/board.h"
#include "hil/observe/wave_log.h"

namespace omnihil {

void watch_pins(mcu::McuBoard& board, WaveLog& log, const std::string& scope);

}  // namespace omnihil
