// An AVR image on one board per wheel, as an omnihil::Firmware in lock-step with the plant. Each board is a
// chip in a process of its own.
//
//   Session session(config, avr_firmware("wheel.hex", "boards/mine.toml", 10.0));
//
// tick() at t lets all boards run from t to t + control_period_ns(), side by side, with their shafts turning
// on at their speed, and gives the mean of what their bridges did in that time, which the plant then holds
// for the same time. The grid is absolute: results do not depend on the loop step, nor on how the processes
// are scheduled. A sensed count that stands still (a stuck encoder) stops the lines. A chip that stops, or a
// process that ends, lets its wheel coast and is the firmware's failure. Cannot: ripple within a coupling
// period, an absolute jump of the count (lines carry edges), motor ticks, commands that do not come by radio.
#pragma once
#include <string>
#include <string_view>

#include "hil/loop/session.h"

namespace omnihil {

// `served`: the radio format that the session serves, which the board's must be; empty: any that there is.
// Reads and checks both files; throws std::invalid_argument with every problem, a line each. The maker does
// if omnihil-avr is not there or refuses.
Session::FirmwareMaker avr_firmware(const std::string& image_file, const std::string& board_file,
                                    double deadline_s, std::string_view served = {});

}  // namespace omnihil
