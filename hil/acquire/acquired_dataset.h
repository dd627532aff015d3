// Finished runs of a plan as a measurement on disk: dataset.toml with what is known of each sensor, and a README of where it is from.
//
//   std::vector<AcquiredRun> runs;                       // rows read back from the folder, in the plan's order
//   acquired_dataset_text(plan, runs, steady_noise(plan, runs, wheel_speed_step_rad_s(format)), format.id);
//
// Noise of a sensor: third differences of its samples where the command has been the same for kSettled_s, robustly (sigma_by_mad over
// sqrt(20), the variance of a third difference); at least what its step leaves, step / sqrt(12). Not stated under kEnough samples.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "hil/acquire/run_log.h"

namespace omnihil {

struct AcquiredRun {
  const PlanRun* run = nullptr;
  RunRows rows;
};

// The signal of a dataset that a column of run_rows is: "wheel_1" is "wheel_speed_1"; empty: none.
std::string signal_of_column(std::string_view column);

// By column; a column that is not there has none.
std::map<std::string, double> steady_noise(const AcquirePlan& plan, const std::vector<AcquiredRun>& runs,
                                           double wheel_speed_step_rad_s);

// `radio`: the format that the packets were in.
std::string acquired_dataset_text(const AcquirePlan& plan, const std::vector<AcquiredRun>& runs,
                                  const std::map<std::string, double>& noise, std::string_view radio);

// Rows of a file that rows_csv wrote; throws std::invalid_argument naming what is wrong.
RunRows rows_from_csv(std::string_view text, const std::string& shown_name);

}  // namespace omnihil
