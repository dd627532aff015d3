// Logs of other tools: tables, wpilog, ULog, MCAP. Not .mat and rosbag2, whose readers are libraries.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "hil/logs/log_table.h"
#include "tests/fuzz/fuzz_target.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const std::string text(text_of(bytes));
  if (text.starts_with("MATLAB") || text.starts_with("SQLite") || text.empty()) return;
  if (text.size() > 4 && text[1] == '\0' && text[2] == '\0' && text[3] == '\0') return;  // .mat of version 4
  static const std::string path =
      (std::filesystem::temp_directory_path() / ("omnihil-fuzz-log-" + std::to_string(::getpid()))).string();
  std::ofstream(path, std::ios::binary) << text;
  try {
    const LogTable log = read_log(path, {});
    demand(!log.series.empty(), "a log has series");
    for (const LogSeries& s : log.series) {
      demand(!s.value.empty(), "a series has values");
      demand((s.time_s == nullptr) == log.by_rows(), "all by rows, or none");
      demand(s.time_s == nullptr || s.time_s->size() == s.value.size(), "a time for each value");
    }
  } catch (const BadLog& bad) {
    demand(std::string(bad.what()).find(path) != std::string::npos, "a refusal names the file");
  }
  std::filesystem::remove(path);
}
