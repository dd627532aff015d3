#include "hil/recording/recording_reader.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "hil/loop/mover_values.h"
#include "hil/recording/command_values.h"
#include "hil/recording/recording_header.h"
#include "hil/text/json_text.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

constexpr std::size_t kMostMovers = 32;  // ids of two teams

// Lines of numbers: how many, and whether a robot's id stands before them.
struct InputLine {
  std::string_view tag;
  RecordedChunk::Kind kind;
  std::size_t values;
  bool of_robot;
  bool may_be_empty;
};
constexpr InputLine kInputLines[] = {
    {"c", RecordedChunk::Kind::kCommand, kCommandValues, true, false},
    {"p", RecordedChunk::Kind::kPlaced, 3, true, false},
    {"v", RecordedChunk::Kind::kPushed, 3, true, false},
    {"a", RecordedChunk::Kind::kPresent, 1, true, false},
    {"b", RecordedChunk::Kind::kBallPlaced, 9, false, true},
    {"w", RecordedChunk::Kind::kBallSeen, 6, false, false},
    {"m", RecordedChunk::Kind::kMovers, kMoverValues, false, true},
};

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

std::string listed(const std::vector<int>& ids) {
  std::string text;
  for (const int id : ids) text += (text.empty() ? "" : ", ") + std::to_string(id);
  return text;
}

// Of {"end":{"now_ns":…,"wall_s":…,"counters":{…}}}; nothing when a part is missing or of another kind.
std::optional<RecordingEnd> end_of(const nlohmann::ordered_json& json) {
  if (!json.is_object() || !json.contains("end") || !json["end"].is_object()) return std::nullopt;
  const auto& end = json["end"];
  for (const char* key : {"now_ns", "wall_s", "counters"}) {
    if (!end.contains(key)) return std::nullopt;
  }
  if (!end["now_ns"].is_number_unsigned() || !end["wall_s"].is_number() || !end["counters"].is_object()) {
    return std::nullopt;
  }
  RecordingEnd read;
  read.now_ns = end["now_ns"].get<std::int64_t>();
  read.wall_s = end["wall_s"].get<double>();
  for (const auto& [name, count] : end["counters"].items()) {
    if (!count.is_number_unsigned()) return std::nullopt;
    read.counters.emplace_back(name, count.get<std::uint64_t>());
  }
  return read;
}

}  // namespace

BadRecording::BadRecording(std::vector<std::string> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

RecordingReader::RecordingReader(std::istream& stream, std::string name)
    : stream_(stream), name_(std::move(name)) {
  if (!read_line()) {
    problems_.push_back(name_ + ":1: header: found nothing, allowed: a line '# {\"format\":\"" +
                        std::string(kRecordingFormat) + "\",…}'");
    return;
  }
  if (!line_.starts_with("# ")) {
    problem("header: found " + in_quotes(line_) + ", allowed: '# {…}'");
    return;
  }
  std::vector<std::string> wrong;
  const auto header = parse_recording_header(std::string_view(line_).substr(2), wrong);
  for (const std::string& what : wrong) problem("header: " + what);
  if (header) {
    header_ = *header;
    usable_ = true;
  }
}

bool RecordingReader::next(RecordedChunk& chunk) {
  while (usable_ && problems_.size() < kMaxProblems && read_line()) {
    if (complete_) {
      problem("after the end line: found " + in_quotes(line_) + ", allowed: nothing");
      return false;
    }
    if (parse_line(chunk)) return true;
  }
  return false;
}

bool RecordingReader::read_line() {
  if (!std::getline(stream_, line_)) return false;
  ++line_number_;
  last_line_cut_ = stream_.eof();  // getline met the end of the file before a line end
  return !last_line_cut_;
}

bool RecordingReader::parse_line(RecordedChunk& chunk) {
  std::string_view rest = line_;
  const std::string_view tag = next_word(rest);
  if (tag == ">" || tag == "<" || tag == "}") {
    chunk.kind = tag == ">"   ? RecordedChunk::Kind::kHostBytes
                 : tag == "<" ? RecordedChunk::Kind::kDongleBytes
                              : RecordedChunk::Kind::kOpponentsBytes;
    return parse_bytes(rest, chunk);
  }
  if (tag == "!") return parse_closed(rest, chunk);
  if (tag == "s") return parse_sample(rest, chunk);
  if (tag == "t") return parse_console(rest, chunk);
  for (const InputLine& line : kInputLines) {
    if (tag != line.tag) continue;
    chunk.kind = line.kind;
    if (line.of_robot ? !parse_robot(rest, chunk) : !parse_time_alone(rest, chunk)) return false;
    return parse_numbers(rest, line.values, line.may_be_empty,
                         line.kind == RecordedChunk::Kind::kMovers ? kMostMovers : 1, chunk);
  }
  if (tag == "#") {
    parse_end(rest);
  } else {
    problem("line tag: found " + in_quotes(tag) +
            ", allowed: '>', '<', '}', '!', 's', 't', 'c', 'p', 'v', 'a', 'b', 'w', 'm', '#'");
  }
  return false;
}

bool RecordingReader::parse_bytes(std::string_view rest, RecordedChunk& chunk) {
  if (!parse_time(rest, chunk)) return false;
  chunk.sample.clear();
  if (rest.empty() || !parse_hex(rest, chunk.bytes)) {
    problem("bytes: found " + in_quotes(rest) + ", allowed: pairs of hex digits, at least one");
    return false;
  }
  return true;
}

bool RecordingReader::parse_closed(std::string_view rest, RecordedChunk& chunk) {
  if (!parse_time(rest, chunk)) return false;
  chunk.kind = RecordedChunk::Kind::kHostClosed;
  chunk.bytes.clear();
  chunk.sample.clear();
  if (rest != "closed") {
    problem("event: found " + in_quotes(rest) + ", allowed: 'closed'");
    return false;
  }
  return true;
}

bool RecordingReader::parse_robot(std::string_view& rest, RecordedChunk& chunk) {
  if (!parse_time(rest, chunk)) return false;
  chunk.bytes.clear();
  chunk.sample.clear();
  const std::string_view id_text = next_word(rest);
  std::int64_t id = -1;
  const std::vector<int> ids = robot_keys(header_);
  if (!parse_integer(id_text, id) || std::find(ids.begin(), ids.end(), id) == ids.end()) {
    problem("robot id: found " + in_quotes(id_text) + ", allowed: " + listed(ids));
    return false;
  }
  chunk.robot_id = static_cast<int>(id);
  return true;
}

bool RecordingReader::parse_numbers(std::string_view rest, std::size_t count, bool may_be_empty,
                                    std::size_t most_times, RecordedChunk& chunk) {
  while (!rest.empty() && chunk.sample.size() < count * most_times) {
    const std::string_view text = next_word(rest);
    double value = 0.0;
    if (!parse_number(text, value)) {
      problem("value " + std::to_string(chunk.sample.size() + 1) + ": found " + in_quotes(text) +
              ", allowed: a finite number");
      return false;
    }
    chunk.sample.push_back(value);
  }
  if (rest.empty() && chunk.sample.empty() && may_be_empty) return true;
  if (rest.empty() && !chunk.sample.empty() && chunk.sample.size() % count == 0) return true;
  problem("values: found " + std::string(rest.empty() ? "fewer" : "more") +
          ", allowed: " + std::to_string(count) + (most_times > 1 ? " of each" : ""));
  return false;
}

bool RecordingReader::parse_time_alone(std::string_view& rest, RecordedChunk& chunk) {
  chunk.bytes.clear();
  chunk.sample.clear();
  chunk.robot_id = 0;
  return parse_time(rest, chunk);
}

bool RecordingReader::parse_sample(std::string_view rest, RecordedChunk& chunk) {
  chunk.kind = RecordedChunk::Kind::kSample;
  if (!parse_robot(rest, chunk)) return false;
  const std::size_t found =
      rest.empty() ? 0 : 1 + static_cast<std::size_t>(std::count(rest.begin(), rest.end(), ' '));
  if (found != header_.columns.size()) {
    problem("sample: found " + std::to_string(found) +
            " values, allowed: " + std::to_string(header_.columns.size()) + ", one per column of the header");
    return false;
  }
  chunk.sample.reserve(found);
  for (const std::string& column : header_.columns) {
    const std::string_view text = next_word(rest);
    double value = 0.0;
    if (column.starts_with("var:") && is_no_number(text, value)) {  // a variable may be what it likes
      chunk.sample.push_back(value);
      continue;
    }
    if (!parse_number(text, value)) {
      problem("column '" + column + "': found " + in_quotes(text) + ", allowed: a finite number");
      return false;
    }
    chunk.sample.push_back(value);
  }
  return true;
}

bool RecordingReader::parse_console(std::string_view rest, RecordedChunk& chunk) {
  constexpr std::int64_t kMostBoards = 16;
  chunk.kind = RecordedChunk::Kind::kConsole;
  if (!parse_robot(rest, chunk)) return false;
  const std::string_view board_text = next_word(rest);
  std::int64_t board = -1;
  if (!parse_integer(board_text, board) || board < 0 || board >= kMostBoards) {
    problem("board: found " + in_quotes(board_text) + ", allowed: 0 to " + std::to_string(kMostBoards - 1));
    return false;
  }
  chunk.board = static_cast<int>(board);
  chunk.port = next_word(rest);
  chunk.text = rest;
  if (!chunk.port.empty()) return true;
  problem("port: found nothing, allowed: a name such as USART2");
  return false;
}

void RecordingReader::parse_end(std::string_view text) {
  const auto json = json_of(text);
  const std::optional<RecordingEnd> read = end_of(json);
  if (!read) {
    problem("end line: found " + in_quotes(text) +
            ", allowed: {\"end\":{\"now_ns\":…,\"wall_s\":…,\"counters\":{…}}}");
    return;
  }
  if (read->now_ns < last_ns_) {
    problem("end: now_ns: found " + std::to_string(read->now_ns) + ", allowed: " + std::to_string(last_ns_) +
            " or later");
  }
  end_ = *read;
  complete_ = true;
}

bool RecordingReader::parse_time(std::string_view& rest, RecordedChunk& chunk) {
  const std::string_view text = next_word(rest);
  if (!parse_integer(text, chunk.now_ns) || chunk.now_ns < 0) {
    problem("time: found " + in_quotes(text) + ", allowed: whole nanoseconds, 0 or more");
    return false;
  }
  if (chunk.now_ns < last_ns_) {
    problem("time: found " + in_quotes(text) + ", allowed: " + std::to_string(last_ns_) +
            " or later: time goes backwards");
    return false;
  }
  last_ns_ = chunk.now_ns;
  return true;
}

void RecordingReader::problem(const std::string& what) {
  problems_.push_back(name_ + ":" + std::to_string(line_number_) + ": " + what);
}

Recording load_recording(std::istream& stream, const std::string& name) {
  RecordingReader reader(stream, name);
  Recording recording;
  RecordedChunk chunk;
  while (reader.next(chunk)) {
    recording.end_ns = chunk.now_ns;
    recording.chunks.push_back(std::move(chunk));
    chunk = {};
  }
  if (!reader.problems().empty()) throw BadRecording(reader.problems());
  recording.header = reader.header();
  recording.complete = reader.complete();
  recording.end = reader.end();
  recording.last_line_cut = reader.last_line_cut();
  if (recording.complete) recording.end_ns = recording.end.now_ns;
  return recording;
}

Recording load_recording(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::error_code is_directory_error;
  if (stream && std::filesystem::is_directory(path, is_directory_error)) {
    throw std::system_error(EISDIR, std::generic_category(), path.string());
  }
  if (!stream) throw std::system_error(errno, std::generic_category(), path.string());
  Recording recording = load_recording(stream, path.string());
  if (stream.bad()) throw std::system_error(EIO, std::generic_category(), path.string());
  return recording;
}

}  // namespace omnihil
