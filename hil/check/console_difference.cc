#include "hil/check/console_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace omnihil {
namespace {

using Console = std::tuple<int, int, std::string>;  // robot, board, port
using Lines = std::vector<const ConsoleLine*>;
struct Said {
  Lines before, now;
};

std::vector<ConsoleLine> recorded_lines(const Recording& recording) {
  std::vector<ConsoleLine> lines;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kConsole)
      lines.push_back({chunk.now_ns, chunk.robot_id, chunk.board, chunk.port, chunk.text});
  }
  return lines;
}

std::string quoted(const ConsoleLine* line) {
  if (line == nullptr) return "nothing";
  return fmt::format("\"{}\" at {:.3f} s", line->text, static_cast<double>(line->at_ns) * 1e-9);
}

}  // namespace

std::string console_difference(const Recording& recording, std::span<const ConsoleLine> replayed) {
  const std::vector<ConsoleLine> recorded = recorded_lines(recording);
  if (recorded.empty()) return {};
  std::map<Console, Said> consoles;
  const auto of = [&](const ConsoleLine& line) -> Said& {
    return consoles[{line.robot_id, line.board, line.port}];
  };
  for (const ConsoleLine& line : recorded) of(line).before.push_back(&line);
  for (const ConsoleLine& line : replayed) of(line).now.push_back(&line);
  std::optional<std::int64_t> first_ns;
  std::string text;
  for (const auto& [console, said] : consoles) {
    const auto same = [](const ConsoleLine* a, const ConsoleLine* b) { return a->text == b->text; };
    const auto [a, b] = std::ranges::mismatch(said.before, said.now, same);
    if (a == said.before.end() && b == said.now.end()) continue;
    const ConsoleLine* const old_line = a == said.before.end() ? nullptr : *a;
    const ConsoleLine* const new_line = b == said.now.end() ? nullptr : *b;
    const std::int64_t at_ns = (new_line != nullptr ? new_line : old_line)->at_ns;
    if (first_ns && *first_ns <= at_ns) continue;
    first_ns = at_ns;
    const auto& [robot, board, port] = console;
    text = fmt::format("{} {}, line {}: {}, recorded {}", board_words(robot, board), port,
                       a - said.before.begin() + 1, quoted(new_line), quoted(old_line));
  }
  return text;
}

}  // namespace omnihil
