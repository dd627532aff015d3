#include "hil/firmware/image_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <set>

#include "hil/loop/session_checks.h"
#include "hil/text/program_files.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEnding = ".toml";

fs::path dialects_folder() { return fs::path(data_folder("boards")) / "dialects"; }

std::string dialects_there_are() {
  std::set<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(dialects_folder(), error))
    if (file.path().extension() == kEnding) names.insert(file.path().stem().string());
  return fmt::format("{}, or the path of a file that ends in {}", fmt::join(names, ", "), kEnding);
}

mcu::DialectFile find_dialect(const std::string& board_file, const std::string& name) {
  const bool is_path = name.ends_with(kEnding);
  mcu::DialectFile found{.allowed = dialects_there_are()};
  const fs::path path =
      is_path ? fs::path(board_file).parent_path() / name : dialects_folder() / (name + kEnding);
  found.path = path.string();
  if (!is_path && (name.empty() || name.find('/') != std::string::npos || !fs::exists(path))) {
    found.error = "unknown";
    return found;
  }
  found.text = read_text_file(found.path, found.error);
  return found;
}

}  // namespace

mcu::BoardContext board_context(const std::string& board_file, std::string_view served) {
  return {.radio = {.known = radio_format_ids(), .served = std::string(served)},
          .find_dialect = [board_file](const std::string& name) { return find_dialect(board_file, name); }};
}

void read_image_files(const std::string& image_file, const std::string& board_file, const ReadImage& image,
                      const ReadBoard& board) {
  std::vector<std::string> problems;
  std::string error;
  const std::string bytes = read_text_file(image_file, error);
  if (!error.empty()) {
    problems.push_back("firmware " + image_file + ": " + error);
  } else {
    std::vector<std::string> found;
    image(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), found);
    for (const std::string& problem : found) problems.push_back("firmware " + image_file + ": " + problem);
  }
  const std::string text = read_text_file(board_file, error);
  if (!error.empty()) {
    problems.push_back("board " + board_file + ": " + error);
  } else {
    std::vector<mcu::BoardProblem> found;
    board(text, found);
    for (const mcu::BoardProblem& problem : found) problems.push_back(problem.text());
  }
  throw_problems(problems);
}

}  // namespace omnihil
