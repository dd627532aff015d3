#include "tools/options/console_options.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <vector>

#include "hil/loop/console_line.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/session_setup.h"

namespace omnihil {

void add_console_option(Verb& verb, std::string& robots) {
  verb.add_option("--console", robots,
                  "print what these robots' boards say on their consoles, such as 3 or 0-5; serve gives them "
                  "what is typed (docs/mcu-boards.md)");
}

namespace {
std::vector<int> ids_of(const std::string& robots) {
  std::vector<std::string> problems;
  std::vector<int> ids = parse_robot_list(robots, problems);
  for (std::string& problem : problems) problem = "--console: " + problem;
  throw_problems(problems);
  return ids;
}

// What has come in by the standard input.
class StandardInput {
 public:
  const std::string& text() {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (open_ && ours() && ::poll(&input, 1, 0) == 1) {
      char bytes[4096];
      const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
      if (count <= 0) {
        open_ = count < 0 && (errno == EINTR || errno == EAGAIN);
        break;
      }
      text_.append(bytes, static_cast<std::size_t>(count));
    }
    return text_;
  }

 private:
  // A terminal stops who reads it from the background.
  static bool ours() { return ::isatty(STDIN_FILENO) == 0 || ::tcgetpgrp(STDIN_FILENO) == ::getpgrp(); }
  bool open_ = true;
  std::string text_;
};
}  // namespace

ConsoleInput console_input(const std::string& robots) {
  if (robots.empty()) return {};
  return [ids = ids_of(robots), in = std::make_shared<StandardInput>()](std::uint32_t robot) {
    const bool asked = std::ranges::binary_search(ids, static_cast<int>(robot));
    return asked ? std::string_view(in->text()) : std::string_view();
  };
}

ConsoleListener console_listener(const std::string& robots) {
  if (robots.empty()) return {};
  const std::vector<int> ids = ids_of(robots);
  return [ids](std::uint32_t robot, int board, const std::string& port, const std::string& line) {
    if (!std::ranges::binary_search(ids, static_cast<int>(robot))) return;
    const std::string who = board_words(static_cast<int>(robot), board);
    std::fprintf(stderr, "%s %s | %s\n", who.c_str(), port.c_str(), line.c_str());
    std::fflush(stderr);
  };
}

}  // namespace omnihil
