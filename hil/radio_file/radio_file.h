// A radio format from a file: the tables of its packets in TOML, as `omnihil formats ID --toml` writes them.
//
//   RadioFile file = load_radio_file("ours.toml");
//   for (const ModelProblem& problem : file.problems) …        // file, line, column, key, value, what is allowed
//   if (file.format != nullptr) use_radio_format(*file.format);
//
// docs/radio/own-format.md describes the file.
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "protocols/radio_format.h"
#include "sim/model/model_file.h"

namespace omnihil {

struct RadioFile {
  const RadioFormat* format = nullptr;  // lives as long as the program; null where there are problems
  std::vector<ModelProblem> problems;
};

RadioFile load_radio_file(const std::filesystem::path& path);
RadioFile read_radio_file(std::string_view text, const std::string& file);

}  // namespace omnihil
