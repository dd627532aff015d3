#include "tools/options/gdb_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "hil/loop/session_checks.h"
#include "hil/wire/open_wire.h"

namespace omnihil {
namespace {

bool all_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

// "3" or "3.1"
void read_robot(const std::string& text, GdbServerOptions& options, std::vector<std::string>& problems) {
  if (text.empty()) return;
  const std::size_t dot = text.find('.');
  const std::string robot = text.substr(0, dot);
  const std::string board = dot == std::string::npos ? "" : text.substr(dot + 1);
  const bool good = all_digits(robot) && robot.size() < 3 &&
                    (dot == std::string::npos || (all_digits(board) && board.size() < 2));
  if (!good) {
    problems.push_back(fmt::format(
        "--gdb-robot: found \"{}\", allowed: a robot such as 3, or a robot's board such as 3.1", text));
    return;
  }
  options.robot = std::stoi(robot);
  if (!board.empty()) options.board = std::stoi(board);
}

}  // namespace

void add_gdb_options(Verb& verb, GdbWords& words) {
  verb.add_option(
      "--gdb", words.at,
      "GDB attaches to the emulated boards here: a TCP port of this computer, or a wire's URL; the "
      "boards wait for it (docs/debugger.md)");
  verb.add_option("--gdb-robot", words.robot, "with --gdb: this robot alone, such as 3, or its board 3.1");
  verb.add_flag("--gdb-run", words.run, "with --gdb: the boards run until GDB comes");
}

std::unique_ptr<GdbServer> open_gdb(const GdbWords& words, std::function<bool()> asked_to_end) {
  std::vector<std::string> problems;
  if (words.at.empty() && (!words.robot.empty() || words.run))
    problems.push_back("--gdb-robot, --gdb-run: need --gdb PORT beside them");
  GdbServerOptions options;
  read_robot(words.robot, options, problems);
  const WireUrl url = read_wire_url(all_digits(words.at) ? "tcp:" + words.at : words.at, "pty");
  if (!words.at.empty()) {
    for (const std::string& problem : wire_problems(url, WireForm::kBytes))
      problems.push_back("--gdb: " + problem);
  }
  throw_problems(problems);
  if (words.at.empty()) return nullptr;
  WireProblem problem;
  std::unique_ptr<ByteWire> wire = open_byte_wire(url, {{"listen", "1"}}, problem);
  if (!wire) throw GdbUnreachable(problem.code, "--gdb: " + problem.what);
  options.wait = !words.run;
  options.asked_to_end = std::move(asked_to_end);
  options.say = [](const std::string& line) {
    std::fprintf(stderr, "%s\n", line.c_str());
    std::fflush(stderr);
  };
  return std::make_unique<GdbServer>(std::move(wire), std::move(options));
}

BoardListener gdb_listener(GdbServer* server) {
  if (server == nullptr) return {};
  return [server](const MadeBoard& made) {
    server->add({.robot = static_cast<int>(made.robot_id),
                 .board = made.board,
                 .machine = &made.mcu.machine(),
                 .image = &made.image,
                 .chip = &made.mcu.chip(),
                 .alone = made.boards == 1});
  };
}

}  // namespace omnihil
