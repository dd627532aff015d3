// Commands that GDB passes on as they are typed: monitor WORDS.
#include <fmt/format.h>

#include <cstring>

#include "hil/debugger/gdb_server.h"
#include "hil/debugger/svd.h"

namespace omnihil {
namespace {

constexpr std::string_view kHelp =
    "monitor reset            reset of the chosen board; it stands at its first instruction\n"
    "monitor where            simulated time, clock and function of the chosen board\n"
    "monitor registers TIM1   a block's registers by name; without a name: the blocks\n"
    "monitor reverse off      keep no earlier states from now on (on: keep them)\n"
    "monitor help             this\n";

std::string where(const DebuggedBoard& board) {
  mcu::Machine& machine = *board.machine;
  const std::uint32_t pc = machine.cpu().reg.r[15];
  const std::string function = board.image != nullptr ? board.image->function_at(pc) : "";
  return fmt::format("robot {} board {}: {:.9f} s, cycle {}, {:.6g} MHz, pc 0x{:08x}{}{}{}\n", board.robot,
                     board.board, 1e-9 * static_cast<double>(machine.to_ns(machine.now())), machine.now(),
                     machine.core_hz() / 1e6, pc, function.empty() ? "" : " ", function,
                     machine.stopped()    ? ", locked up"
                     : machine.sleeping() ? ", asleep"
                                          : "");
}

std::string registers(const DebuggedBoard& board, std::string_view block) {
  if (board.chip == nullptr) return "this board's registers have no names\n";
  std::string text, last, names;
  for (const NamedRegister& r : named_registers(*board.chip)) {
    if (r.block != last) names += (names.empty() ? "" : " ") + r.block;
    last = r.block;
    if (r.block != block) continue;
    std::uint8_t raw[4] = {};
    std::uint32_t value = 0;
    board.machine->peek(r.address, raw);
    std::memcpy(&value, raw, sizeof value);
    text += fmt::format("{:<10} 0x{:08x}  0x{:08x}\n", r.name, r.address, value);
  }
  if (!text.empty()) return text;
  return block.empty() ? names + "\n" : fmt::format("no block \"{}\"; there are {}\n", block, names);
}

}  // namespace

std::string gdb_monitor(std::string_view words, const DebuggedBoard& board, bool& reset) {
  const std::size_t end = words.find(' ');
  const std::string_view word = words.substr(0, end);
  if (word == "where") return where(board);
  if (word == "help") return std::string(kHelp);
  if (word == "registers")
    return registers(board, end == std::string_view::npos ? "" : words.substr(end + 1));
  if (word == "reset") {
    reset = true;
    return "reset\n";
  }
  return fmt::format(
      "monitor: found \"{}\", allowed: reset, where, registers, reverse on, reverse off, help\n", words);
}

}  // namespace omnihil
