// Reads the runs of a dataset from their files and holds them against its channels and its model.
//
//   add_runs(plan, "bench", "bench/dataset.toml", dataset, problems);    // dataset.runs, dataset.notes
#pragma once
#include <string>
#include <vector>

#include "hil/dataset/dataset_plan.h"

namespace omnihil {

// `dataset` has its channels; every run of the plan is appended, or what is wrong with it is said.
void add_runs(const DatasetPlan& plan, const std::string& folder, const std::string& toml_name,
              Dataset& dataset, std::vector<ModelProblem>& problems);

}  // namespace omnihil
