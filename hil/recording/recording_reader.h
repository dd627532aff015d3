// Reads a recording line by line, strictly: what is not understood is refused, with its place.
//
//   Recording recording = load_recording("drive.omnirec");      // throws BadRecording, std::system_error
//
//   RecordingReader reader(stream, "drive.omnirec");            // a recording larger than memory
//   RecordedChunk chunk;
//   while (reader.next(chunk)) …
//   if (!reader.problems().empty()) …                           // "drive.omnirec:7: robot id: found '9', …"
//
// Refused: unknown tags and header keys, a wrong number of values, numbers that are not finite, broken hex,
// time going backwards, anything after the end line. A last line without line end is what a killed run
// leaves: it is left out, and last_line_cut() says so.
#pragma once
#include <istream>
#include <stdexcept>
#include <string>
#include <vector>

#include "hil/recording/recording.h"

namespace omnihil {

class BadRecording : public std::runtime_error {
 public:
  explicit BadRecording(std::vector<std::string> problems);
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

class RecordingReader {
 public:
  // Reads the header; without a usable one there are problems() and next() gives nothing.
  RecordingReader(std::istream& stream, std::string name);

  const RecordingHeader& header() const { return header_; }
  // The next chunk; lines with a problem are left out. False at the end or after kMaxProblems.
  bool next(RecordedChunk& chunk);
  const std::vector<std::string>& problems() const { return problems_; }
  bool complete() const { return complete_; }  // the end line was read
  const RecordingEnd& end() const { return end_; }
  bool last_line_cut() const { return last_line_cut_; }
  std::int64_t line_number() const { return line_number_; }

  static constexpr std::size_t kMaxProblems = 20;

 private:
  bool read_line();
  bool parse_line(RecordedChunk& chunk);
  bool parse_bytes(std::string_view rest, RecordedChunk& chunk);
  bool parse_closed(std::string_view rest, RecordedChunk& chunk);
  bool parse_robot(std::string_view& rest, RecordedChunk& chunk);
  bool parse_numbers(std::string_view rest, std::size_t count, bool may_be_empty, std::size_t most_times,
                     RecordedChunk& chunk);
  bool parse_time_alone(std::string_view& rest, RecordedChunk& chunk);
  bool parse_sample(std::string_view rest, RecordedChunk& chunk);
  bool parse_console(std::string_view rest, RecordedChunk& chunk);
  void parse_end(std::string_view json);
  bool parse_time(std::string_view& rest, RecordedChunk& chunk);
  void problem(const std::string& what);

  std::istream& stream_;
  std::string name_;
  std::string line_;
  std::int64_t line_number_ = 0;
  std::int64_t last_ns_ = 0;
  RecordingHeader header_;
  RecordingEnd end_;
  bool usable_ = false;
  bool complete_ = false;
  bool last_line_cut_ = false;
  std::vector<std::string> problems_;
};

// Throws std::system_error (cannot be opened or read) or BadRecording (all its problems, kMaxProblems at
// most).
Recording load_recording(const std::filesystem::path& path);
Recording load_recording(std::istream& stream, const std::string& name);

}  // namespace omnihil
