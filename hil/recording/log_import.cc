#include "hil/recording/log_import.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "hil/recording/capture_import.h"
#include "hil/recording/stream_file.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

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
    out.chunks.push_back(std::move(chunk));
  }
  if (faults.empty() && out.chunks.empty()) faults.push_back(name + ": no line TIME_S > HEX or TIME_S < HEX");
  if (!faults.empty()) throw BadStream(faults);
  out.most_moved_ns = put_off_to_steps(out.chunks, step_ns);
  out.first_s = *first_s;
  out.end_ns = (last_ns / step_ns + 2) * step_ns;
  return out;
}

}  // namespace omnihil
