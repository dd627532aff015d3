// Logs with a meaning, as the files of a dataset: CSV with the values as logged, dataset.toml with scales, a README, a
// picture.
//
//   LogDataset made = make_log_dataset(runs, options);
//   for (const std::string& d : made.doubts) std::puts(d.c_str());        // choices to be made: then there are no files
//   for (const DatasetFile& f : made.files) folder.write(f.name, f.text);
//
// A table's rows stay rows; those without a time, or at the time of the row before, are left out and counted. Topics
// are put on the clock of the motion with the most samples: what was asked of the drive holds its last value, anything
// else stands at its nearest instant within half a period and is empty elsewhere; by how much the drive is late is
// said. Poses of another device beside a run are put on its clock (pose_join.h). The first instant is 0 s. Throws BadLog where
// time goes backwards. Cannot: align clocks of other logs; resample.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/dataset/dataset_export.h"
#include "hil/logs/pose_join.h"
#include "hil/logs/recognise.h"
#include "hil/text/hashed_file.h"

namespace omnihil {

struct LogRun {
  std::string path;
  HashedFile file;
  LogTable table;
  Split use = Split::kTraining;
  std::string pose_path{};  // poses that another device took of the same drive; empty: none
  LogTable pose{};
};

struct LogDatasetOptions {
  MeaningContext context;
  std::vector<ColumnMap> asked;
  std::string title;
  std::string model_text;       // of model.toml
  double counts_per_rev = 0.0;  // of an encoder, after quadrature; 0: not known
  bool on_output = false;       // the encoder's shaft
  PoseGeometry geometry;        // of a robot: what its wheels say of its motion, where there are poses
  double fit_share = 1.0;       // of a fit run's time; the rest becomes a holdout run
};

struct LogDataset {
  std::vector<DatasetFile> files;  // dataset.toml, model.toml, README.md, import.svg, the runs
  std::vector<std::string> table;  // what was taken for what, a line a column
  std::vector<std::string> notes, doubts;
};

LogDataset make_log_dataset(const std::vector<LogRun>& runs, const LogDatasetOptions& options);

}  // namespace omnihil
