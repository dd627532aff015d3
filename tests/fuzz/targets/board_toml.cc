// Board files of the emulated microcontrollers.
#include "firmware_iface/mcu/board/board_spec.h"
#include "tests/fuzz/fuzz_target.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  std::vector<mcu::BoardProblem> problems;
  const auto spec = mcu::read_board(text_of(bytes), "fuzz.toml", problems);
  demand(spec.has_value() == problems.empty(), "a board or a problem");
  for (const mcu::BoardProblem& problem : problems) demand(!problem.text().empty(), "a problem has words");
}
