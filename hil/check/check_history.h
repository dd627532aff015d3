// The trend over runs: one JSON line per recording and run, appended to a file that CI keeps.
//
//   append_history("check-history.jsonl", outcomes, "1a2b3c4", "2026-03-01");
//   CheckHistory history = load_history("check-history.jsonl");
//   history.runs_of("drive.omnirec");             // in the order in which they were appended
//
// What is kept of a run is the signal that is furthest from its tolerance, and how far: a slow drift shows before a
// test fails. A line that is not understood is left alone, and counted.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "hil/check/check_recording.h"

namespace omnihil {

struct HistoryRun {
  std::string label;  // commit or whatever the user calls it
  std::string date;
  std::string file;
  bool passed = false;
  std::string signal;           // furthest from its tolerance, relative to it
  double over_tolerance = 0.0;  // largest difference by tolerance; at most 1e6
};

struct CheckHistory {
  std::vector<HistoryRun> runs;
  std::size_t lines_not_understood = 0;

  std::vector<HistoryRun> runs_of(const std::string& file) const;
};

HistoryRun history_run(const CheckOutcome& outcome, const std::string& label, const std::string& date);

// Throws std::system_error with the path. A file that is not there has no runs.
void append_history(const std::string& path, std::span<const CheckOutcome> outcomes, const std::string& label,
                    const std::string& date);
CheckHistory load_history(const std::string& path);
CheckHistory parse_history(const std::string& text);

}  // namespace omnihil
