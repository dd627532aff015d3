// Where a board first said something else than when it was recorded.
//
//   console_difference(recording, replayed);    // "robot 1 USART2, line 4: \"stall\" at 0.310 s, recorded \"ready\" at 0.305 s"
//
// Consoles are compared each by itself, line by line, without their times. Empty: they agree, or the recording has no
// lines. Cannot: lines inserted, after which all others are off by one; it names the first.
#pragma once
#include <span>
#include <string>

#include "hil/loop/console_line.h"
#include "hil/recording/recording.h"

namespace omnihil {

std::string console_difference(const Recording& recording, std::span<const ConsoleLine> replayed);

}  // namespace omnihil
