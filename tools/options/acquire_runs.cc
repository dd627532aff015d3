#include "tools/options/acquire_runs.h"

#include <fmt/format.h>

#include <cstdio>
#include <iostream>

#include "hil/acquire/acquire_report.h"
#include "hil/dataset/dataset_reader.h"
#include "hil/serve/serve_signals.h"
#include "tools/exit_codes.h"

namespace omnihil {
namespace {

// Waits for Enter before a run; false: the input has ended.
bool confirm_run(const PlanRun& run, const char* make_ready) {
  fmt::print("{} ({:.1f} s): {} and press Enter ", run.name, run.duration_s, make_ready);
  std::fflush(stdout);
  std::string line;
  return static_cast<bool>(std::getline(std::cin, line));
}

// Exit code of a run that was stopped.
int stopped(const PlanRun& run, const DrivenRun& driven, const AcquireFolder& folder) {
  fmt::print(stderr, "omnihil acquire: {}: stopped: {}\nwhat is whole is in {}; --resume goes on\n", run.name,
             driven.problem, folder.making().string());
  if (driven.wire_lost) return kExitIo;
  return StopSignals::requested() ? kExitInterrupted : kExitDiffers;
}

}  // namespace

std::optional<int> drive_runs(const AcquireWords& words, const AcquirePlan& plan, AcquireFolder& folder,
                              const char* make_ready, const DriveOne& drive_one) {
  const StopSignals signals;
  int driven = 0;
  for (const PlanRun& run : plan.runs) {
    if (folder.has(run.name)) continue;
    if (words.runs > 0 && driven == words.runs) {
      fmt::print("{} runs driven; --resume goes on with {}\n", driven, run.name);
      return kExitOk;
    }
    if (words.confirm && !confirm_run(run, make_ready)) return kExitInterrupted;
    const DrivenRun done = drive_one(run, utc_now());
    if (!done.problem.empty()) return stopped(run, done, folder);
    folder.add_run(run.name, done.csv, done.packets, done.note);
    ++driven;
    fmt::print("{}: {}\n", run.name, done.words);
    std::fflush(stdout);
  }
  return std::nullopt;
}

int finish_measurement(const AcquirePlan& plan, AcquireFolder& folder, const Describe& describe) {
  std::vector<AcquiredRun> runs;
  std::vector<std::string> notes;
  std::size_t rows = 0;
  for (const PlanRun& run : plan.runs) {
    runs.push_back({&run, rows_from_csv(folder.csv(run.name), run.name + ".csv")});
    notes.push_back(folder.note(run.name));
    rows += runs.back().rows.time_s.size();
  }
  const Described text = describe(runs, notes);
  folder.describe(text.dataset, text.readme);
  const DatasetReading reading = read_dataset(folder.making().string(), "");
  if (!reading.dataset) {
    fmt::print(stderr, "omnihil acquire: what was measured cannot be used; it is kept in {}\n{}\n",
               folder.making().string(), lines_of(reading.problems));
    return kExitDiffers;
  }
  folder.finish();
  fmt::print("{}: {} runs, {} rows\n", folder.path().string(), runs.size(), rows);
  return kExitOk;
}

}  // namespace omnihil
