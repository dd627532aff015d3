#include "hil/recording/log_import.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "hil/recording/stream_file.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

constexpr std::int64_t kTimeRounding_ns = 1'000;  // of a time that was written with six decimals
constexpr std::size_t kMostFaults = 20;
constexpr double kLongestLog_s = 86'400.0;  // a day: a longer one has a unit that is not seconds

}  // namespace

LogImport parse_radio_log(const std::string& text, const std::string& name, std::int64_t step_ns) {
  LogImport out;
  std::vector<std::string> faults;
  std::optional<double> first_s;
  std::int64_t last_ns = 0;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line) && faults.size() < kMostFaults; ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string time, way, hex, more;
    if (!(words >> time)) continue;
    words >> way >> hex;
    const auto fault = [&](const char* what, const std::string& found, const std::string& allowed) {
      faults.push_back(name + ":" + std::to_string(number) + ": " + what + ": found " + in_quotes(found) +
                       ", allowed: " + allowed);
    };
    RecordedChunk chunk;
    double seconds = 0.0;
    if ((way != ">" && way != "<") || words >> more) {
      fault("line", line, "TIME_S > HEX or TIME_S < HEX");
      continue;
    }
    if (!parse_number(time, seconds)) {
      fault("time", time, "seconds");
      continue;
    }
    const double since_s = seconds - first_s.value_or(seconds);
    if (!(since_s >= 0.0 && since_s <= kLongestLog_s) || std::llround(since_s * 1e9) < last_ns) {
      fault("time", time, "not before the line above, and within a day");
      continue;
    }
    if (hex.empty() || !parse_hex(hex, chunk.bytes)) {
      fault("bytes", hex, "pairs of hex digits, at least one");
      continue;
    }
    first_s = first_s.value_or(seconds);
    last_ns = chunk.now_ns = std::llround(since_s * 1e9);
    chunk.kind = way == ">" ? RecordedChunk::Kind::kHostBytes : RecordedChunk::Kind::kDongleBytes;
    if (way == ">") {
      // The loop takes what has come by a step's start: the first step after the write.
      const std::int64_t taken_ns = (chunk.now_ns - kTimeRounding_ns + step_ns - 1) / step_ns * step_ns;
      out.most_moved_ns = std::max(out.most_moved_ns, taken_ns - chunk.now_ns);
      chunk.now_ns = std::max<std::int64_t>(0, taken_ns);
    }
    out.chunks.push_back(std::move(chunk));
  }
  if (faults.empty() && out.chunks.empty()) faults.push_back(name + ": no line TIME_S > HEX or TIME_S < HEX");
  if (!faults.empty()) throw BadStream(faults);
  // A host's write that was put off may have passed a dongle's.
  std::ranges::stable_sort(out.chunks, {}, &RecordedChunk::now_ns);
  out.first_s = *first_s;
  out.end_ns = (last_ns / step_ns + 2) * step_ns;
  return out;
}

}  // namespace omnihil
