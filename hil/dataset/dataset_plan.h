// What a dataset.toml says, before any of its files is opened: channels, runs, and where each stands.
//
//   DatasetPlan plan = read_dataset_plan(text, "bench/dataset.toml", problems);
//   plan.dataset.channels; plan.runs[0].run.file;
//
// Problems are collected; what is wrong is left out of the plan.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "identify/record/dataset.h"
#include "sim/model/model_file.h"

namespace omnihil {

struct TextPlace {
  int line = 0;
  int column = 0;
};

struct KnownNumber {
  std::string path;
  double value = 0.0;
  std::string written;
  TextPlace at;
};

struct RunPlan {
  Run run;  // without data
  TextPlace at;
  std::vector<KnownNumber> known;
};

struct DatasetPlan {
  Dataset dataset;  // without runs
  bool rig_known = false;
  std::string model;  // as the file names it
  TextPlace model_at;
  std::string firmware, board;  // likewise; empty: none
  std::string radio;            // format; empty: not said
  std::optional<double> boot_s;
  TextPlace firmware_at, board_at, radio_at;
  TextPlace channels_at;
  std::vector<RunPlan> runs;
};

DatasetPlan read_dataset_plan(std::string_view text, const std::string& shown_name,
                              std::vector<ModelProblem>& problems);

}  // namespace omnihil
