#include "hil/loop/console_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace omnihil {

std::string board_words(int robot_id, int board) {
  return board == 0 ? fmt::format("robot {}", robot_id) : fmt::format("robot {} board {}", robot_id, board);
}

std::string ConsoleLine::words() const {
  return fmt::format("{:.3f} s {} {} | {}", static_cast<double>(at_ns) * 1e-9, board_words(robot_id, board),
                     port, text);
}

ConsoleKeeper::Listener ConsoleKeeper::listener(Listener also) {
  return [this, also = std::move(also)](std::uint32_t robot_id, int board, const std::string& port,
                                        const std::string& line) {
    lines_.push_back({now_ns_, static_cast<int>(robot_id), board, port, line});
    if (also) also(robot_id, board, port, line);
  };
}

std::span<const ConsoleLine> last_lines(std::span<const ConsoleLine> lines, std::int64_t until_ns) {
  constexpr std::size_t kShown = 20;  // as many as the report of a board has (console_text.h)
  const auto end = std::ranges::upper_bound(lines, until_ns, {}, &ConsoleLine::at_ns);
  const auto count = static_cast<std::size_t>(end - lines.begin());
  const std::size_t kept = std::min(count, kShown);
  return lines.subspan(count - kept, kept);
}

}  // namespace omnihil
