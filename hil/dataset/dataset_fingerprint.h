// Which measurement it was: a short hash of its files, for what is written of it.
//
//   dataset_fingerprint("bench", dataset);      // "sha256:9f86d081884c"
//
// The first 12 digits of the SHA-256 of dataset.toml and then of its runs' files, in its order: those of
// `cat dataset.toml RUNS… | sha256sum`. The model is not among them: it changes with every fit. Files that
// cannot be read any more throw std::runtime_error.
#pragma once
#include <string>

#include "identify/record/dataset.h"

namespace omnihil {

std::string dataset_fingerprint(const std::string& path, const Dataset& dataset);

}  // namespace omnihil
