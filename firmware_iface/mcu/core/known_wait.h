// A busy wait whose turn is known, instruction by instruction: what its registers are before each, and all that it reads.
//
// While nothing of that has changed, the core comes round to the same instructions at the same distances, so where it is
// at any instant needs no execution (Cpu::pass_wait). Learnt by running one turn in single steps (Cpu::learn_wait).
#pragma once
#include <cstdint>
#include <vector>

#include "firmware_iface/mcu/core/registers.h"

namespace omnihil::mcu {

struct KnownWait {
  static constexpr std::size_t kLongest = 48;  // instructions of a turn; a choice

  struct Moment {
    std::int64_t at = 0;  // since the turn's start, in 16ths of a cycle
    Registers registers;
  };
  // Read by the turn, or stored by it and there already.
  struct Value {
    std::uint32_t address = 0, value = 0;
    unsigned bytes = 0;
    const std::uint8_t* memory = nullptr;  // null: a register of the core's own peripherals
  };

  std::vector<Moment> moments;  // empty: none is known
  std::int64_t turn = 0;
  std::vector<Value> values;
  std::uint64_t code_changes = 0;  // Memory::code_changes() while it was learnt
  std::int64_t steady_until = 0;   // as the bus has said of what it reads; 0: to be asked
  std::size_t here = 0;            // the moment at which it was left
  std::uint32_t first_pc = 0, last_pc = 0;
};

}  // namespace omnihil::mcu
