// What `omnihil acquire` says and writes down: what will happen, what a run was, whence the data are.
//
//   std::cout << plan_words(plan, robot, format, true);        // the dry run
//   folder.add_run(run.name, csv, end.packets, run_note(run, end, rows, started));
//   folder.describe(dataset, readme_text(about, plan, notes));
#pragma once
#include <string>
#include <vector>

#include "hil/acquire/acquire_loop.h"
#include "sim/rolling/rolling_params.h"

namespace omnihil {

std::string plan_words(const AcquirePlan& plan, const RollingParams<double>& robot, const RadioFormat& format,
                       bool vision);
std::string run_note(const PlanRun& run, const RunEnd& end, const RunRows& rows, const std::string& started);

struct AcquireAbout {
  std::string device, team, commit, plan_sha256, model_sha256;
  const RadioFormat* format = nullptr;
  int robot = 0;
};
std::string readme_text(const AcquireAbout& about, const AcquirePlan& plan,
                        const std::vector<std::string>& notes);

std::string utc_now();  // "2026-03-01T12:34:56Z"

}  // namespace omnihil
