// WPILib's data log. Source: WPILib Data Log File Format Specification, version 1.0 (wpiutil/doc/datalog.adoc): header, then
// records of a bit field with the sizes of entry id, payload size and timestamp (us), and the payload; entry 0 is control.
#include <fmt/format.h>

#include <map>

#include "hil/logs/log_bytes.h"
#include "hil/logs/log_formats.h"
#include "hil/logs/topic_series.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

struct WpilogEntry {
  std::string name, type;
  std::size_t left_out = 0;
};

// The numbers of a payload, one after another; false: this type holds none, or not a whole number of them.
template <typename T, typename Take>
bool each_number(std::string_view payload, bool is_list, Take take) {
  if (payload.size() % sizeof(T) != 0 || (!is_list && payload.size() != sizeof(T))) return false;
  for (std::size_t i = 0; i * sizeof(T) < payload.size(); ++i) {
    T value;
    std::memcpy(&value, payload.data() + i * sizeof(T), sizeof value);
    take(i, static_cast<double>(value));
  }
  return true;
}

template <typename Take>
bool numbers_of(std::string_view type, std::string_view payload, Take take) {
  const bool is_list = type.ends_with("[]");
  if (is_list) type.remove_suffix(2);
  if (type == "double") return each_number<double>(payload, is_list, take);
  if (type == "float") return each_number<float>(payload, is_list, take);
  if (type == "int64") return each_number<std::int64_t>(payload, is_list, take);
  if (type == "boolean") return each_number<std::uint8_t>(payload, is_list, take);
  return false;
}

}  // namespace

LogTable read_wpilog(const std::string& path) {
  std::string error;
  const std::string bytes = read_text_file(path, error);
  if (!error.empty()) throw BadLog(path + ": " + error);
  LogBytes in(bytes, path);
  in.skip(6);  // "WPILOG"
  const auto version = in.number<std::uint16_t>();
  if (version >> 8 != 1)
    throw BadLog(fmt::format("{}: version {}.{}; allowed: 1.x", path, version >> 8, version & 0xFF));
  in.text32();  // extra header
  std::map<std::uint64_t, WpilogEntry> entries;
  TopicSeries topics;
  std::size_t unknown = 0;
  bool cut = false;
  while (!in.at_end()) {
    const auto sizes = in.number<std::uint8_t>();
    const std::size_t id_size = (sizes & 3u) + 1, payload_size = (sizes >> 2 & 3u) + 1,
                      time_size = (sizes >> 4 & 7u) + 1;
    if (in.left() < id_size + payload_size + time_size) {
      cut = true;
      break;
    }
    const std::uint64_t id = in.bytes_number(id_size), size = in.bytes_number(payload_size);
    const std::int64_t time_ns = ns_of_us(in.bytes_number(time_size));
    if (in.left() < size) {
      cut = true;
      break;
    }
    const std::string_view payload = in.text(size);
    if (id == 0) {
      LogBytes control(payload, path, in.at() - size);
      const auto kind = control.number<std::uint8_t>();
      if (kind != 0) continue;  // 1: an entry ends, 2: its metadata
      const auto entry = control.number<std::uint32_t>();
      WpilogEntry& started = entries[entry];
      started.name = control.text32();
      started.type = control.text32();
      continue;
    }
    const auto entry = entries.find(id);
    if (entry == entries.end()) {
      ++unknown;
      continue;
    }
    WpilogEntry& e = entry->second;
    const bool is_list = e.type.ends_with("[]");
    const bool taken = numbers_of(e.type, payload, [&](std::size_t i, double value) {
      topics.add(is_list ? fmt::format("{}[{}]", e.name, i) : e.name, time_ns, value);
    });
    e.left_out += !taken;
  }
  LogTable log = topics.table(LogFormat::kWpilog);
  if (cut) log.notes.push_back(path + ": ends within a record, which is left out");
  if (unknown > 0)
    log.notes.push_back(
        fmt::format("{}: {} records of entries that were never started left out", path, unknown));
  for (const auto& [id, e] : entries) {
    if (e.left_out > 0)
      log.notes.push_back(
          fmt::format("{}: {}: {} values of type {} left out", path, e.name, e.left_out, e.type));
  }
  if (log.series.empty())
    throw BadLog(path + ": has no numbers; allowed: entries of type double, float, int64, boolean");
  return log;
}

}  // namespace omnihil
