// How long a frame is, by the tables and the framing of its format alone.
//
//   SizedStream stream(frames_by_tables(format, "start-connection\r"), counts);
//
// COBS: up to the next 00. Lists: begin and number, packets of the length of those to robots. Without framing: the
// packet whose type fields and constants hold their content.
#pragma once
#include "protocols/dongles/sized_stream.h"
#include "protocols/radio_format.h"

namespace omnihil {

// `line`: a frame of its own that hosts write before the others; may be empty.
FrameBytes frames_by_tables(const RadioFormat& format, std::string_view line);

// Two delimiters in a row enclose nothing: hosts send one to clear the line.
bool is_empty(const RadioFormat& format, std::span<const std::uint8_t> frame);

}  // namespace omnihil
