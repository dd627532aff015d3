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
using Said = std::map<Console, std::vector<ConsoleLine>>;

Said recorded_lines(const Recording& recording) {
  Said said;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind != RecordedChunk::Kind::kConsole) continue;
    said[{chunk.robot_id, chunk.board, chunk.port}].push_back(
        {chunk.now_ns, chunk.robot_id, chunk.board, chunk.port, chunk.text});
  }
  return said;
}

std::string quoted(const ConsoleLine* line) {
  if (line == nullptr) return "nothing";
  return fmt::format("\"{}\" at {:.3f} s", line->text, static_cast<double>(line->at_ns) * 1e-9);
}

}  // namespace

std::string console_difference(const Recording& recording, std::span<const ConsoleLine> replayed) {
  const Said before = recorded_lines(recording);
  if (before.empty()) return {};
  Said now;
  for (const ConsoleLine& line : replayed) now[{line.robot_id, line.board, line.port}].push_back(line);
  Said all = before;
  all.insert(now.begin(), now.end());
  std::optional<std::int64_t> first_ns;
  std::string text;
  for (const auto& entry : all) {
    const Console& console = entry.first;
    const std::vector<ConsoleLine> none;
    const auto of = [&](const Said& said) { return said.contains(console) ? said.at(console) : none; };
    const std::vector<ConsoleLine> was = of(before), is = of(now);
    const auto [a, b] = std::ranges::mismatch(was, is, {}, &ConsoleLine::text, &ConsoleLine::text);
    if (a == was.end() && b == is.end()) continue;
    const ConsoleLine* const old_line = a == was.end() ? nullptr : &*a;
    const ConsoleLine* const new_line = b == is.end() ? nullptr : &*b;
    const std::int64_t at_ns = new_line != nullptr ? new_line->at_ns : old_line->at_ns;
    if (first_ns && *first_ns <= at_ns) continue;
    first_ns = at_ns;
    const auto& [robot, board, port] = console;
    text = fmt::format("robot {}{} {}, line {}: {}, recorded {}", robot,
                       board == 0 ? std::string() : fmt::format(" board {}", board), port,
                       a - was.begin() + 1, quoted(new_line), quoted(old_line));
  }
  return text;
}

}  // namespace omnihil
