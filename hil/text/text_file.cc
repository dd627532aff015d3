#include "hil/text/text_file.h"

#include <fstream>
#include <system_error>

namespace omnihil {
namespace {

void put(const std::filesystem::path& path, std::string_view text, std::ios::openmode mode) {
  std::ofstream out(path, std::ios::binary | mode);
  out << text;
  out.flush();
  if (!out) throw std::system_error(std::make_error_code(std::errc::io_error), path.string());
}

}  // namespace

std::string read_text_file(const std::filesystem::path& path, std::string& error) {
  namespace fs = std::filesystem;
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) {
    error = "no such file";
    return "";
  }
  if (fs::is_directory(status)) {
    error = "is a folder, not a file";
    return "";
  }
  if (!fs::is_regular_file(status)) {
    error = "is no ordinary file";
    return "";
  }
  const std::uintmax_t size = fs::file_size(path, code);
  std::ifstream in(path, std::ios::binary);
  std::string text(code ? 0 : static_cast<std::size_t>(size), '\0');
  if (!in || !in.read(text.data(), static_cast<std::streamsize>(text.size()))) {
    error = "cannot be read";
    return "";
  }
  if (text.empty()) error = "is empty";
  return text;
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  put(path, text, std::ios::out);
}

void append_text_file(const std::filesystem::path& path, std::string_view text) {
  put(path, text, std::ios::app);
}

}  // namespace omnihil
