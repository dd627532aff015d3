#include "tools/options/console_options.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "hil/loop/console_line.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/session_setup.h"

namespace omnihil {

void add_console_option(Verb& verb, std::string& robots) {
  verb.add_option(
      "--console", robots,
      "print what these robots' boards say on their consoles, such as 3 or 0-5 (docs/mcu-boards.md)");
}

ConsoleListener console_listener(const std::string& robots) {
  if (robots.empty()) return {};
  std::vector<std::string> problems;
  const std::vector<int> ids = parse_robot_list(robots, problems);
  for (std::string& problem : problems) problem = "--console: " + problem;
  throw_problems(problems);
  return [ids](std::uint32_t robot, int board, const std::string& port, const std::string& line) {
    if (!std::ranges::binary_search(ids, static_cast<int>(robot))) return;
    const std::string who = board_words(static_cast<int>(robot), board);
    std::fprintf(stderr, "%s %s | %s\n", who.c_str(), port.c_str(), line.c_str());
    std::fflush(stderr);
  };
}

}  // namespace omnihil
