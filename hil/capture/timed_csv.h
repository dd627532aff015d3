// Tables of time and bytes, as logic analysers and scripts of one's own write them.
//
//   Capture capture = read_timed_csv("time_ms,way,data\n33.3,>,03 01 FE\n", "uart.csv", 0);
//   std::string text = write_timed_csv(capture.pieces);                   // "time_s,way,hex\n0.033300000,>,0301fe\n"
//
// One row a write: time, hex, and perhaps a way (>, host, tx: the host's; <, dongle, rx: the dongle's). Comma, semicolon or tab;
// with a semicolon a decimal comma, too. A header names the columns (time…, hex or data or bytes…, way or direction) and the
// unit ("time_ms", "time [us]"); without one the columns are time, hex, way, in seconds unless `time_unit_ns` says otherwise.
// Hex may have blanks, colons, "0x" between bytes. Columns can_id (hex, as candump has it), from_port and to_port are written
// where there are such pieces, and read. Tolerated and said: rows that are none, a last line without an end.
// Cannot: quotes that hold a separator, times of day; say that a CAN frame of up to 8 bytes was CAN FD, or switched its rate.
#pragma once
#include <span>
#include <string>

#include "hil/capture/captured.h"

namespace omnihil {

bool looks_like_timed_csv(std::string_view first_line);
Capture read_timed_csv(const std::string& text, const std::string& name, std::int64_t time_unit_ns);
// Times in seconds with nine decimals. Throws BadCapture where times are below 0 or go backwards.
std::string write_timed_csv(std::span<const Captured> pieces);

}  // namespace omnihil
