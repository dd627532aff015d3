// The model that a fit gave, as the text of a file that says of each number which data moved it and when.
//
//   replace_file_keeping_old("model.toml", fitted_model_text(fit, "bench", dataset));
#pragma once
#include <string>

#include "identify/estimate/fit.h"

namespace omnihil {

std::string fitted_model_text(const FitResult& fit, const std::string& dataset_path, const Dataset& dataset);

}  // namespace omnihil
