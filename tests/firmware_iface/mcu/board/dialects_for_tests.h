// The dialects that come with the program, as tests of its parts find them.
#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "firmware_iface/mcu/board/wheel_commands_reader.h"

namespace omnihil::mcu {

inline DialectFile built_in_dialect(const std::string& name) {
  DialectFile file{.path = OMNIHIL_SOURCE_DIR "/boards/dialects/" + name + ".toml",
                   .allowed = "those that there are"};
  std::ifstream in(file.path);
  if (!in) file.error = "unknown";
  file.text.assign(std::istreambuf_iterator<char>(in), {});
  return file;
}

inline BoardContext with_dialects() { return {.find_dialect = built_in_dialect}; }

// For a board of so many motors.
inline WheelWords dialect_words(const std::string& name, int motors) {
  std::vector<BoardProblem> problems;
  const auto dialect = read_dialect(built_in_dialect(name), motors, problems);
  for (const BoardProblem& problem : problems) ADD_FAILURE() << problem.text();
  return dialect ? dialect->words : WheelWords{};
}

}  // namespace omnihil::mcu
