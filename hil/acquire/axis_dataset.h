// Finished runs of one axis as a measurement on disk, and what is said of them: the dry run, dataset.toml, README.
//
//   std::cout << axis_plan_words(plan, model);                      // what will happen, by the model
//   folder.add_run(run.name, rows_csv(rows), done.packets, axis_run_note(run, done, rows, started));
//   folder.describe(axis_dataset_text(plan, runs, counts_per_turn), axis_readme_text(about, plan, notes));
//
// A velocity that a motor controller estimates is a column and no signal, its filter would be one more thing to know, and the
// position has it all; so is its current, which is of an instant, where a signal is the mean over its period.
#pragma once
#include <string>
#include <vector>

#include "hil/acquire/acquired_dataset.h"
#include "hil/acquire/axis_loop.h"
#include "sim/model/axis_model.h"

namespace omnihil {

// `counts_per_turn`: of the rotor's encoder; 0: there is a position.
std::string axis_dataset_text(const AcquirePlan& plan, const std::vector<AcquiredRun>& runs,
                              double counts_per_turn);

// By the model, from rest: how fast, how far, how much current.
std::string axis_plan_words(const AcquirePlan& plan, const AxisModel& model);

struct AxisAbout {
  std::string device, bus, commit, plan_sha256, model_sha256;
  int id = 0;
  bool device_clock = false;
};
std::string axis_run_note(const PlanRun& run, const AxisRunEnd& done, const RunRows& rows,
                          const std::string& started);
std::string axis_readme_text(const AxisAbout& about, const AcquirePlan& plan,
                             const std::vector<std::string>& notes);

}  // namespace omnihil
