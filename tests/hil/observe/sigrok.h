// sigrok-cli at a trace: another reader of the format, with decoders for what stands in it.
//
//   const std::vector<std::string> said = sigrok_says(file, "-P uart:rx=USART1_TX:baudrate=115200 -A uart=rx-data");
#pragma once
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli.h"

namespace omnihil {

inline bool has_sigrok() { return std::system("command -v sigrok-cli >/dev/null") == 0; }

// What decoders say, a line each, without their name before it. How it ends is not looked at: after decoders that count, its
// Python aborts while it is taken down (0.5.3, "bool_dealloc").
inline std::vector<std::string> sigrok_says(const std::filesystem::path& file, const std::string& options) {
  const std::filesystem::path said = file.string() + ".said";
  const std::string command =
      "sigrok-cli -I vcd -i" + shell(file) + options + " >" + shell(said) + "2>/dev/null";
  static_cast<void>(std::system(command.c_str()));
  std::istringstream lines(text_of(said));
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find("-1: ");
    if (colon != std::string::npos) all.push_back(line.substr(colon + 4));
  }
  std::filesystem::remove(said);
  return all;
}

}  // namespace omnihil
