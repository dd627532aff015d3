#include "hil/recording/stream_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "hil/recording/recording_reader.h"
#include "hil/text/json_text.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kMaxProblems = 20;
constexpr double kLongest_s = 1e9;  // so that nanoseconds fit their integer

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

// Takes writes one by one, in either form, and keeps what is wrong with them.
class StreamBuilder {
 public:
  void add(const std::string& place, double seconds, bool is_number, std::string_view time_text,
           std::string_view hex) {
    if (problems.size() == kMaxProblems) return;
    StreamChunk chunk;
    const double earliest_s = stream.chunks.empty() ? 0.0 : static_cast<double>(last_ns_) / 1e9;
    if (!is_number || !(seconds >= 0.0 && seconds <= kLongest_s)) {
      return refuse(place, "time", time_text, "seconds, 0 to 1000000000");
    }
    chunk.at_ns = std::llround(seconds * 1e9);
    if (chunk.at_ns < last_ns_) {
      return refuse(place, "time", time_text, std::to_string(earliest_s) + " or later: time goes backwards");
    }
    if (hex.empty() || !parse_hex(hex, chunk.bytes)) {
      return refuse(place, "bytes", hex, "pairs of hex digits, at least one");
    }
    last_ns_ = chunk.at_ns;
    stream.chunks.push_back(std::move(chunk));
  }
  void refuse(const std::string& place, const char* what, std::string_view found,
              const std::string& allowed) {
    problems.push_back(place + ": " + what + ": found " + in_quotes(found) + ", allowed: " + allowed);
  }

  HostStream stream;
  std::vector<std::string> problems;

 private:
  std::int64_t last_ns_ = 0;
};

HostStream parse_text(const std::string& text, const std::string& name) {
  StreamBuilder builder;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    const std::string place = name + ":" + std::to_string(number);
    std::string time, hex, more;
    if (!(words >> time)) continue;
    words >> hex;
    if (words >> more) {
      builder.refuse(place, "line", line, "TIME_S HEX");
      continue;
    }
    double seconds = 0.0;
    const bool is_number = parse_number(time, seconds);
    builder.add(place, seconds, is_number, time, hex);
  }
  if (!builder.problems.empty()) throw BadStream(builder.problems);
  return std::move(builder.stream);
}

const Json& pick_session(const Json& sessions, const std::string& name, std::string& session) {
  std::string names;
  for (const auto& [key, rows] : sessions.items()) names += (names.empty() ? "" : ", ") + key;
  if (session.empty() && sessions.size() == 1) session = sessions.begin().key();
  const auto at = sessions.find(session);
  if (at == sessions.end()) {
    throw BadStream({name + ": session: found " + in_quotes(session) + ", allowed: " + names});
  }
  return *at;
}

HostStream parse_json(const std::string& text, const std::string& name, std::string session) {
  const Json json = json_of(text);
  if (!json.is_object() || !json.contains("sessions") || !json["sessions"].is_object()) {
    throw BadStream(
        {name + ": found " + in_quotes(text) + R"(, allowed: {"sessions": {NAME: [[SECONDS, "HEX"], …]}})"});
  }
  const Json& rows = pick_session(json["sessions"], name, session);
  StreamBuilder builder;
  std::size_t number = 0;
  for (const Json& row : rows) {
    const std::string place = name + ": session '" + session + "' row " + std::to_string(++number);
    if (!row.is_array() || row.size() != 2 || !row[1].is_string()) {
      builder.refuse(place, "row", row.dump(), "[SECONDS, \"HEX\"]");
      if (builder.problems.size() == kMaxProblems) break;
      continue;
    }
    const double seconds = row[0].is_number() ? row[0].get<double>() : 0.0;
    builder.add(place, seconds, row[0].is_number(), row[0].dump(), row[1].get_ref<const std::string&>());
  }
  if (!builder.problems.empty()) throw BadStream(builder.problems);
  builder.stream.session = session;
  return std::move(builder.stream);
}

}  // namespace

std::uint64_t HostStream::byte_count() const {
  std::uint64_t sum = 0;
  for (const StreamChunk& chunk : chunks) sum += chunk.bytes.size();
  return sum;
}

BadStream::BadStream(const std::vector<std::string>& problems) : std::runtime_error(joined_lines(problems)) {}

HostStream stream_of(const Recording& recording) {
  HostStream stream;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kHostBytes) stream.chunks.push_back({chunk.now_ns, chunk.bytes});
  }
  return stream;
}

std::string to_text(const HostStream& stream, const std::string& comment) {
  std::string text = "# " + comment + "\n# TIME_S HEX: what the host wrote, and when\n";
  for (const StreamChunk& chunk : stream.chunks) {
    append_number(text, static_cast<double>(chunk.at_ns) / 1e9);
    text += ' ';
    append_hex(text, chunk.bytes);
    text += '\n';
  }
  return text;
}

HostStream parse_stream(const std::string& text, const std::string& name, const std::string& session) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  HostStream stream;
  if (first != std::string::npos && text[first] == '{') {
    stream = parse_json(text, name, session);
  } else if (!session.empty()) {
    throw BadStream(
        {name + ": session: found " + in_quotes(session) + ", allowed: none, the file has no sessions"});
  } else if (text.starts_with("# {")) {
    std::istringstream lines(text);
    stream = stream_of(load_recording(lines, name));
  } else {
    stream = parse_text(text, name);
  }
  if (stream.chunks.empty())
    throw BadStream({name + ": found no bytes to play, allowed: at least one write"});
  return stream;
}

HostStream load_stream(const std::filesystem::path& path, const std::string& session) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw std::system_error(EISDIR, std::generic_category(), path.string());
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::system_error(errno, std::generic_category(), path.string());
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) throw std::system_error(EIO, std::generic_category(), path.string());
  return parse_stream(text, path.string(), session);
}

}  // namespace omnihil
