// A line of text that a robot's board said on a console (docs/mcu-boards.md), and who keeps them.
//
//   ConsoleKeeper keeper;                        // an observer of the session, for the time
//   listeners.on_line = keeper.listener();
//   for (const ConsoleLine& line : keeper.lines()) fmt::print("{}\n", line.words());   // "0.120 s robot 1 USART2 | ready"
//
// A line's time is that of the control tick before it was told.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hil/loop/session.h"

namespace omnihil {

// Who speaks: "robot 1", "robot 1 board 2" of a further board.
std::string board_words(int robot_id, int board);

struct ConsoleLine {
  std::int64_t at_ns = 0;
  int robot_id = 0, board = 0;
  std::string port, text;

  std::string words() const;
};

class ConsoleKeeper : public SessionObserver {
 public:
  using Listener = std::function<void(std::uint32_t robot_id, int board, const std::string& port,
                                      const std::string& line)>;
  // `also` hears every line, too; may be empty. Not to be called after the keeper's end.
  Listener listener(Listener also = {});
  void robot_tick(std::int64_t now_ns, const RobotSample&) override { now_ns_ = now_ns; }
  std::span<const ConsoleLine> lines() const { return lines_; }

 private:
  std::int64_t now_ns_ = 0;
  std::vector<ConsoleLine> lines_;
};

// The last lines that were said until then, as many as a report of something that failed shows.
std::span<const ConsoleLine> last_lines(std::span<const ConsoleLine> lines, std::int64_t until_ns);

}  // namespace omnihil
