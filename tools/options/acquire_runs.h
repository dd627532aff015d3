// What `omnihil acquire` does alike for a robot and for one axis: the runs that the folder lacks, one by one, and the measurement
// that they are at the end.
//
//   std::optional<int> ended = drive_runs(words, plan, folder, "put the robot in its place", drive_one);
//   int exit_code = ended ? *ended : finish_measurement(plan, folder, describe);
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hil/acquire/acquire_folder.h"
#include "hil/acquire/acquired_dataset.h"

namespace omnihil {

struct AcquireWords {
  std::string device = "./dongle", model = "omni_default", out;
  int runs = 0;
  bool dry_run = false, resume = false, confirm = false;
};

struct DrivenRun {
  std::string problem{};  // why it was stopped; empty: at its end
  bool wire_lost = false;
  std::string csv{}, packets{}, note{};  // of one that ran to its end
  std::string words{};                   // how much came of it
};
using DriveOne = std::function<DrivenRun(const PlanRun& run, const std::string& started_utc)>;

// Exit code where it ended before the last run; none: all are there.
std::optional<int> drive_runs(const AcquireWords& words, const AcquirePlan& plan, AcquireFolder& folder,
                              const char* make_ready, const DriveOne& drive_one);

// dataset.toml and README of all runs.
struct Described {
  std::string dataset, readme;
};
using Describe =
    std::function<Described(const std::vector<AcquiredRun>& runs, const std::vector<std::string>& notes)>;

// Exit code.
int finish_measurement(const AcquirePlan& plan, AcquireFolder& folder, const Describe& describe);

}  // namespace omnihil
