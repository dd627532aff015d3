// What a real robot's radio was heard to say, as a recording: bytes both ways with their times, nothing else.
//
//   const LogImport log = parse_radio_log(text, "field.txt", 1'000'000);     // loop step in ns
//   log.chunks;                                       // of a recording without samples
//
// Text, a line each: "TIME_S > HEX" what the host wrote, "TIME_S < HEX" what came back; '#' begins a comment. Times do not
// decrease and may begin anywhere (Unix time): the first is 0. The host's writes are put off to the next loop step,
// as the loop takes them; by how much at most is told.
// Throws BadStream with every fault: line, what was found, what is allowed.
#pragma once
#include <string>
#include <vector>

#include "hil/recording/recording.h"

namespace omnihil {

struct LogImport {
  std::vector<RecordedChunk> chunks;
  std::int64_t end_ns = 0;         // a whole number of loop steps, after the last byte
  std::int64_t most_moved_ns = 0;  // of the host's bytes
  double first_s = 0.0;            // as it stood in the file
};

LogImport parse_radio_log(const std::string& text, const std::string& name, std::int64_t step_ns);

}  // namespace omnihil
