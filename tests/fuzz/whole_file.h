// A file's bytes, for targets that need one beside their input.
#pragma once
#include <fstream>
#include <iterator>
#include <string>

#include "tests/fuzz/fuzz_target.h"

namespace omnihil {

inline std::string whole_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  demand(file.good(), path.c_str());
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace omnihil
