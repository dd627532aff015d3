#include "hil/firmware/image_files.h"

#include "hil/loop/session_checks.h"
#include "hil/text/text_file.h"

namespace omnihil {

mcu::ServedRadio served_radio(std::string_view format) {
  return {.known = radio_format_ids(), .served = std::string(format)};
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
