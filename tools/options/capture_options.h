// Captures of other tools among the verbs' files: are they one, which bytes of it are meant, what was tolerated.
//
//   add_capture_options(verb, words);
//   if (is_capture_file("field.pcapng")) {
//     const CaptureFilter filter = capture_filter(words);              // throws std::invalid_argument
//     const Capture capture = load_capture("field.pcapng", filter);    // throws BadCapture, std::system_error
//     print_notes(capture.notes);
//   }
#pragma once
#include <string>
#include <vector>

#include "hil/capture/read_capture.h"
#include "tools/command_line.h"

namespace omnihil {

struct CaptureWords {
  int udp_port = 0;  // 0: not given
  std::string can_id, can_back_id, time_unit;
};

void add_capture_options(Verb& verb, CaptureWords& words);
CaptureFilter capture_filter(const CaptureWords& words);

// By how it begins; false also of what cannot be opened, which the reader of recordings then says.
bool is_capture_file(const std::string& path);
Capture load_capture(const std::string& path, const CaptureFilter& filter);
// "note: …", a line each, on the error output: what is printed may be piped on.
void print_notes(const std::vector<std::string>& notes);

}  // namespace omnihil
