// Logs of candump (can-utils): what `candump -l`, `-L` and the console print, with whatever time stamps.
//
//   Capture capture = read_candump(text, "candump.log");
//   std::string log = write_candump(capture.pieces, "can0");           // as candump -l, microseconds
//
// Reads "(1436509052.249713) can0 044#2A36", "123##1AABB" (FD), "12345678#" (29-bit id), 6 or 9 decimals, " R" or " T" at
// the end (-x), and the console's "can0  044   [2]  2A 36" with stamps of -t a, A, d, z or none. Tolerated and said:
// differences instead of times, dates without a zone (read as UTC), no times, error and remote frames, CAN XL, lines that are
// none, a last line that is cut, several interfaces.
// Cannot: tell whether seconds that only rise are differences (-t d) or times (-t z): taken as times.
// The writer cannot carry more than 64 bytes a frame or times before 0, and refuses what it cannot (BadCapture).
// Source: can-utils, candump.c and lib.h (CL_LONGCFSZ); logs are what canplayer reads.
#pragma once
#include <span>
#include <string>

#include "hil/capture/captured.h"

namespace omnihil {

bool looks_like_candump(std::string_view first_line);
Capture read_candump(const std::string& text, const std::string& name);
std::string write_candump(std::span<const Captured> pieces, const std::string& interface);

// What both CAN writers hold frames to: throws BadCapture with the piece's number.
void check_can_pieces(std::span<const Captured> pieces);
// The lengths that a CAN FD frame can have; a classic one: 0 to 8.
bool is_can_length(std::size_t bytes, bool fd);

}  // namespace omnihil
