// The nominal model that goes with a dataset (format omnihil-model/1): what was simulated, as a user would
// believe it, with tolerances and sources from the robot's and the motor's own files, in one text.
//
//   std::string text = dataset_model_text(*read_bundle(bundle).model);
//
// Only the keys that the dataset format names are written, and the model's effects: tyres, encoder and
// firmware stay out (the encoder's resolution is in dataset.toml).
#pragma once
#include <string>

#include "sim/model/model_file.h"

namespace omnihil {

std::string dataset_model_text(const ModelFile& model);

}  // namespace omnihil
