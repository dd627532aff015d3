// Dialects of [wheel_commands]: what is read can be said, at any time and speed.
#include <algorithm>

#include "firmware_iface/mcu/board/wheel_commands_reader.h"
#include "tests/fuzz/fuzz_target.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  std::vector<mcu::BoardProblem> problems;
  const auto dialect =
      mcu::read_dialect({.path = "fuzz.toml", .text = std::string(text_of(bytes))}, 2, problems);
  demand(dialect.has_value() == problems.empty(), "a dialect or a problem");
  for (const mcu::BoardProblem& problem : problems) demand(!problem.text().empty(), "a problem has words");
  if (!dialect) return;
  for (const double omega_rad_s : {0.0, -1e9, 1e9}) {
    for (const std::int64_t n : {std::int64_t{0}, std::int64_t{1} << 40}) {
      std::vector<BusFrame> said;
      const double speeds[] = {omega_rad_s, 1.0};
      speak(dialect->words, {1, 2, n % 1000 * dialect->words.period_ns}, speeds, said);
      for (const BusFrame& frame : said) {
        demand(frame.size > 0 && frame.size <= (dialect->serial ? BusFrame::kCapacity : 8),
               "a frame that fits");
        demand(std::all_of(frame.data.begin() + frame.size, frame.data.end(), [](auto b) { return b == 0; }),
               "nothing behind its end");
      }
    }
  }
}
