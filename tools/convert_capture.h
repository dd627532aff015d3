// The work of `convert` on bytes with times: captures of other tools, or a recording's bytes, in a form that other tools read.
//
//   write_pieces(pieces, "candump", "run.log");                    // throws BadCapture, FileExists
//   convert_capture("field.pcapng", "asc", "field.asc", words, nullptr);
#pragma once
#include <span>
#include <string>
#include <vector>

#include "hil/capture/captured.h"
#include "protocols/radio_format.h"
#include "tools/options/capture_options.h"

namespace omnihil {

// `to`: candump, asc (bytes as frames of 8 with the ids of read_capture.h), pcapng, csv. What is lost is said in notes.
void write_pieces(std::span<const Captured> pieces, const std::string& to, const std::string& out);

// The same of a capture, and the stream of what its host wrote. `format`: of the radio, where the capture does not say which
// way its bytes went; may be null.
void convert_capture(const std::string& path, const std::string& to, const std::string& out,
                     const CaptureWords& words, const RadioFormat* format);

}  // namespace omnihil
