#include "hil/dataset/dataset_fingerprint.h"

#include <filesystem>
#include <stdexcept>

#include "hil/text/sha256.h"
#include "hil/text/text_file.h"

namespace omnihil {

std::string dataset_fingerprint(const std::string& path, const Dataset& dataset) {
  namespace fs = std::filesystem;
  constexpr std::size_t kDigits = 12;  // 48 bits: enough to tell measurements apart, short enough to read
  const fs::path toml = fs::is_directory(path) ? fs::path(path) / "dataset.toml" : fs::path(path);
  Sha256 hash;
  const auto add = [&](const fs::path& file) {
    std::string error;
    const std::string text = read_text_file(file, error);
    if (!error.empty()) throw std::runtime_error(file.string() + ": " + error);
    hash.add(text);
  };
  add(toml);
  for (const Run& run : dataset.runs) add(toml.parent_path() / run.file);
  return "sha256:" + hash.hex().substr(0, kDigits);
}

}  // namespace omnihil
