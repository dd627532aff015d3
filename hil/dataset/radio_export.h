// A recording as the dataset of a team that logs its radio and a camera: commands and reported wheel speeds, no duties.
//
//   DatasetExport made = make_radio_dataset(recording, model, heard_commands(recording, format), {.robot = 2});
//
// Rows where something came in: a command, telemetry (every telemetry_period_s), a camera frame; the other cells are empty.
// The model gets the reference firmware's [controller] (wheel_tuning.h) where that ran, with tolerances for what the plain
// loop of radio_controller.h has otherwise; another firmware's has to be written in.
// Cannot: commands in the field's frame, headings, duties: such commands are left out and counted.
#pragma once
#include <span>

#include "hil/dataset/dataset_export.h"
#include "hil/recording/heard_commands.h"

namespace omnihil {

struct RadioDatasetOptions {
  std::optional<int> robot;  // none: all
  double camera_Hz = 60.0;
  double telemetry_period_s = 0.01;
  double holdout_ratio = 1.0 / 3.0;
};

// Throws std::invalid_argument as make_dataset does, and when no command of a robot can be told by a dataset.
DatasetExport make_radio_dataset(const Recording& recording, const ModelFile& model,
                                 std::span<const HeardCommand> commands, const RadioDatasetOptions& options);

// [controller] of a model whose robot runs the reference firmware, with tolerances where the plain loop is not all of it.
std::string reference_controller_text(const RobotModel& model);

}  // namespace omnihil
