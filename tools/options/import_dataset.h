// The work of `import` on logs of numbers: a dataset with a table of what was taken for what.
//
//   words.files = {"run.csv"};  words.model = "model.toml";  words.out = "bench";
//   int exit_code = import_dataset(words);                   // kExitBadInput with the flags to give where there is doubt
#pragma once
#include <string>
#include <vector>

#include "tools/command_line.h"

namespace omnihil {

struct ImportDatasetWords {
  std::vector<std::string> files, holdout, extrapolation, maps, columns, imposed, poses;
  std::string model, out, title, shaft = "rotor";
  double counts_per_rev = 0.0, period_s = 0.0, split = 1.0;
  bool si = false;

  bool any() const;  // an option of these was given
};

void add_import_dataset_options(Verb& verb, ImportDatasetWords& words);
int import_dataset(ImportDatasetWords words);

}  // namespace omnihil
