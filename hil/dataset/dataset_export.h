// Turns a recording into a measurement: a folder in the dataset format "omnihil-dataset/1", rig "robot".
//
//   DatasetExport made = make_dataset(recording, *read_bundle(bundle).model, {.robot = 2});
//   NewFolder folder("out");
//   for (const DatasetFile& file : made.files) folder.write(file.name, file.text);
//   folder.finish();
//
// One CSV per run, one row per recorded sample. Signals are what the robot's board measures: duty, encoder,
// motor current, bus voltage, gyro, accelerometer; vision_* is the true pose, given only in rows where a
// camera frame falls (camera_Hz) and exact. Duty is empty where the bridges are off: the wheel runs free
// there, and no duty describes it.
//
// Several robots are one run each, the last of them held out. One robot is cut in time: the first part to
// fit, the last third held out.
//
// Limits: a recording that keeps every Nth tick only has the drive of those ticks, and its current is the
// mean over one tick, not over the row's interval. For a measurement record every tick.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/recording/recording.h"
#include "sim/model/model_file.h"

namespace omnihil {

struct DatasetOptions {
  std::optional<int> robot;          // none: all
  double camera_Hz = 60.0;           // rate of the league's vision
  double holdout_ratio = 1.0 / 3.0;  // of one robot's time, at its end
};

struct DatasetFile {
  std::string name;
  std::string text;
};

struct DatasetExport {
  std::vector<DatasetFile> files;  // dataset.toml, model.toml, the runs
  std::size_t rows = 0;
  std::vector<std::string> notes;  // what a reader of the data should know
};

// Throws std::invalid_argument when the recording has no samples of that robot, or lacks a column.
DatasetExport make_dataset(const Recording& recording, const ModelFile& model, const DatasetOptions& options);

// All samples as one CSV: time_s, robot_id and every column of the recording.
std::string wide_csv(const Recording& recording, std::optional<int> robot);

}  // namespace omnihil
