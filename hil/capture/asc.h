// ASC logs of Vector's tools (CANalyzer, CANoe), which python-can, BUSMASTER and others write too.
//
//   Capture capture = read_asc(text, "drive.asc", {});
//   std::string log = write_asc(capture.pieces);                // base hex, absolute times in seconds, UTC date
//
// Reads classic and CAN FD frames, base hex or dec, times absolute or relative (to the event before, also one that is no
// frame), a date line in English, German or French or in numbers. Tolerated and said: no header, a date that is not
// understood (times then count from the start), dates without a zone (all: read as UTC), events and other buses, error
// and remote frames, lines that are none, a last line that is cut, times in milliseconds where the file says so ("ms" in a comment or
// behind "timestamps") or `time_unit_ns` does.
// Cannot: tell milliseconds from seconds by the numbers; split channels; names in place of ids.
// The writer refuses what an ASC frame cannot hold (BadCapture), and rounds times down to the microsecond.
// Source: no public specification; Vector's "CAN logging ASCII format" as python-can's asc.py (4.1.0) has it.
#pragma once
#include <span>
#include <string>

#include "hil/capture/captured.h"

namespace omnihil {

bool looks_like_asc(std::string_view first_line);
// `time_unit_ns` 0: as the file says, else seconds.
Capture read_asc(const std::string& text, const std::string& name, std::int64_t time_unit_ns);
std::string write_asc(std::span<const Captured> pieces);

}  // namespace omnihil
