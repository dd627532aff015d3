#include "tools/options/capture_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "hil/text/recording_text.h"
#include "hil/text/text_file.h"

namespace omnihil {

void add_capture_options(Verb& verb, CaptureWords& words) {
  verb.add_option("--udp-port", words.udp_port, "of a capture with UDP: the dongle's port").range(1, 65535);
  verb.add_option("--can-id", words.can_id, "of a capture with CAN: the host's bytes, in hex (default: 7E0)");
  verb.add_option("--can-back-id", words.can_back_id, "... and the dongle's (default: 7E8)");
  verb.add_option("--time-unit", words.time_unit, "of asc and CSV (default: as the file says, else s)")
      .one_of({"s", "ms", "us", "ns"});
}

CaptureFilter capture_filter(const CaptureWords& words) {
  CaptureFilter filter;
  std::vector<std::string> problems;
  const auto id = [&](const char* option, const std::string& text) {
    const auto value = parse_can_id(text);
    if (!text.empty() && !value)
      problems.push_back(fmt::format("{}: found {}, allowed: hex, 0 to 1FFFFFFF", option, in_quotes(text)));
    return value;
  };
  if (words.udp_port != 0) filter.udp_port = static_cast<std::uint16_t>(words.udp_port);
  filter.can_id = id("--can-id", words.can_id);
  filter.can_back_id = id("--can-back-id", words.can_back_id);
  const std::string& unit = words.time_unit;
  filter.time_unit_ns = unit == "s"    ? 1'000'000'000
                        : unit == "ms" ? 1'000'000
                        : unit == "us" ? 1'000
                        : unit == "ns" ? 1
                                       : 0;
  if (!problems.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(problems, "\n")));
  return filter;
}

bool is_capture_file(const std::string& path) {
  constexpr std::size_t kHead = 65'536;  // longer than any comment above the first frame
  if (!std::filesystem::is_regular_file(path)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string head(kHead, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return !head.starts_with("# {\"format\":") && is_capture(head);
}

Capture load_capture(const std::string& path, const CaptureFilter& filter) {
  std::string error;
  const std::string text = read_text_file(path, error);
  if (!error.empty()) throw std::system_error(std::make_error_code(std::errc::io_error), path + ": " + error);
  return read_capture(text, path, filter);
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace omnihil
