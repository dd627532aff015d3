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
  return {std::filesystem::path(path).filename().string(), sha256_of(text)};
}

}  // namespace omnihil
