#include "hil/recording/snapshot_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hil/text/dataset_files.h"
#include "hil/text/json_text.h"
#include "hil/text/recording_text.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {
constexpr const char* kFormat = "omnihil-snapshot/1";
}

void write_snapshot(const std::string& file, const Snapshot& snapshot) {
  nlohmann::ordered_json head;
  head["format"] = kFormat;
  head["commit"] = snapshot.commit;
  head["robots"] = snapshot.robots;
  head["at_ns"] = snapshot.at_ns;
  write_new_file(file, json_text(head) + "\n" + to_hex(snapshot.world) + "\n");
}

Snapshot load_snapshot(const std::string& file, std::vector<std::string>& problems) {
  std::string error;
  const std::string text = read_text_file(file, error);
  Snapshot snapshot;
  if (!error.empty()) {
    problems.push_back(fmt::format("{}: {}", file, error));
    return snapshot;
  }
  const std::size_t line_end = text.find('\n');
  const nlohmann::ordered_json head = json_of(std::string_view(text).substr(0, line_end));
  if (!head.is_object() || head.value("format", "") != kFormat || !head.contains("at_ns") ||
      !head["at_ns"].is_number_integer()) {
    problems.push_back(fmt::format("{}:1: allowed: {{\"format\":\"{}\",…,\"at_ns\":…}}", file, kFormat));
    return snapshot;
  }
  snapshot.at_ns = head["at_ns"].get<std::int64_t>();
  std::string_view digits = line_end == std::string::npos ? "" : std::string_view(text).substr(line_end + 1);
  while (digits.ends_with('\n')) digits.remove_suffix(1);
  if (digits.empty() || !parse_hex(digits, snapshot.world)) {
    snapshot.world.clear();
    problems.push_back(fmt::format("{}:2: allowed: the world as pairs of hex digits", file));
  }
  return snapshot;
}

}  // namespace omnihil
