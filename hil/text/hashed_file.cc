#include "hil/text/hashed_file.h"

#include <filesystem>
#include <system_error>

#include "hil/text/sha256.h"
#include "hil/text/text_file.h"

namespace omnihil {

HashedFile hash_file(const std::string& path) {
  std::string error;
  const std::string text = read_text_file(path, error);
  if (!error.empty()) throw std::system_error(std::make_error_code(std::errc::io_error), path + ": " + error);
  Sha256 hash;
  hash.add(text);
  return {std::filesystem::path(path).filename().string(), hash.hex()};
}

}  // namespace omnihil
