#include "firmware_iface/mcu/rp2040/pio_machine.h"

#include <algorithm>

namespace omnihil::mcu::rp2040 {
namespace {
std::uint32_t low(unsigned bits) { return bits >= 32 ? 0xFFFFFFFFu : (1u << bits) - 1u; }
std::uint32_t turned(std::uint32_t x, unsigned by) { return by == 0 ? x : x >> by | x << (32 - by); }
std::uint32_t reversed(std::uint32_t x) {
  std::uint32_t r = 0;
  for (unsigned i = 0; i < 32; ++i) r |= (x >> i & 1u) << (31 - i);
  return r;
}
enum Code : unsigned { kJmp, kWait, kIn, kOut, kPushPull, kMov, kIrq, kSet };
}  // namespace

void StateMachine::restart() {
  state.isr = 0;
  state.isr_count = 0;
  state.osr_count = 32;
  state.forced = -1;
  state.waits_for_flag = false;
}

bool StateMachine::acts_outside() const {
  const bool side = (pinctrl >> 29) > ((execctrl >> 30 & 1u) != 0 ? 1u : 0u);
  if (side) return true;
  // All of the memory: a program may jump out of its wrap.
  return std::any_of(program->begin(), program->end(), [](std::uint16_t word) {
    const unsigned code = word >> 13, to = word >> 5 & 7u;
    return code == kIrq || (code == kOut && (to == 0 || to == 4 || to == 7)) ||
           (code == kMov && (to == 0 || to == 4)) || (code == kSet && (to == 0 || to == 4));
  });
}

std::uint32_t StateMachine::pins_in(const PioPort& port) const {
  return turned(port.inputs, pinctrl >> 15 & 31u);
}

void StateMachine::write_pins(std::uint32_t& word, unsigned base, unsigned count, std::uint32_t value) const {
  for (unsigned i = 0; i < count; ++i) {
    const unsigned pin = (base + i) & 31u;
    word = (word & ~(1u << pin)) | (value >> i & 1u) << pin;
  }
}

// The five bits behind the code: side-set from the top, the rest is delay.
unsigned StateMachine::delay(std::uint16_t instruction) const {
  return instruction >> 8 & low(5 - std::min(pinctrl >> 29, 5u));
}

void StateMachine::side_set(PioPort& port, std::uint16_t instruction) const {
  const unsigned bits = pinctrl >> 29, all = instruction >> 8 & 31u;
  const bool optional = (execctrl >> 30 & 1u) != 0;
  unsigned count = bits;
  std::uint32_t value = bits == 0 ? 0u : all >> (5 - bits);
  if (optional && bits > 0) {
    if ((value >> (bits - 1) & 1u) == 0) return;
    --count;
    value &= low(count);
  }
  write_pins((execctrl >> 29 & 1u) != 0 ? port.enable : port.out, pinctrl >> 10 & 31u, count, value);
}

bool StateMachine::condition(unsigned which, const PioPort& port) {
  switch (which) {
    case 1:
      return state.x == 0;
    case 2:
      return state.x-- != 0;
    case 3:
      return state.y == 0;
    case 4:
      return state.y-- != 0;
    case 5:
      return state.x != state.y;
    case 6:
      return (port.inputs >> (execctrl >> 24 & 31u) & 1u) != 0;
    case 7:
      return state.osr_count < threshold(25);
    default:
      return true;
  }
}

bool StateMachine::jump(std::uint16_t instruction, const PioPort& port) {
  if (!condition(instruction >> 5 & 7u, port)) return true;
  state.pc = instruction & 31u;
  jumped_ = true;
  return true;
}

bool StateMachine::wait(std::uint16_t instruction, PioPort& port) {
  const bool wanted = (instruction >> 7 & 1u) != 0;
  const unsigned index = instruction & 31u;
  switch (instruction >> 5 & 3u) {
    case 0:
      return ((port.inputs >> index & 1u) != 0) == wanted;
    case 1:
      return ((pins_in(port) >> index & 1u) != 0) == wanted;
    case 2: {
      const std::uint32_t mask = 1u << flag(index);
      if (((port.flags & mask) != 0) != wanted) return false;
      if (wanted) port.flags &= ~mask;
      return true;
    }
    default:
      return true;
  }
}

bool StateMachine::push() {
  if (rx.size() >= rx_depth()) {
    rx_stall = true;
    return false;
  }
  rx.push_back(state.isr);
  state.isr = 0;
  state.isr_count = 0;
  return true;
}

bool StateMachine::shift_in(std::uint16_t instruction, const PioPort& port) {
  const bool automatic = joins(16);
  // Stalled in its push: the bits are in already.
  if (automatic && state.isr_count >= threshold(20)) return push();
  const unsigned bits = (instruction & 31u) == 0 ? 32 : instruction & 31u;
  std::uint32_t data = source(instruction >> 5 & 7u, port) & low(bits);
  if (joins(18))
    state.isr = bits == 32 ? data : state.isr >> bits | data << (32 - bits);
  else
    state.isr = bits == 32 ? data : state.isr << bits | data;
  state.isr_count = std::min(state.isr_count + bits, 32u);
  return !automatic || state.isr_count < threshold(20) || push();
}

// Autopull, in every cycle (§3.5.4.2).
void StateMachine::refill() {
  if (!joins(17) || state.osr_count < threshold(25) || tx.empty()) return;
  state.osr = tx.front();
  tx.pop_front();
  state.osr_count = 0;
}

// What OUT and MOV have in common of their destinations; `bits` are in the ISR then.
void StateMachine::give(unsigned destination, std::uint32_t data, unsigned bits, PioPort& port) {
  switch (destination) {
    case 0:
      write_pins(port.out, pinctrl & 31u, pinctrl >> 20 & 63u, data);
      break;
    case 1:
      state.x = data;
      break;
    case 2:
      state.y = data;
      break;
    case 5:
      state.pc = data & 31u;
      jumped_ = true;
      break;
    case 6:
      state.isr = data;
      state.isr_count = bits;
      break;
    default:
      break;
  }
}

bool StateMachine::shift_out(std::uint16_t instruction, PioPort& port) {
  const bool automatic = joins(17);
  if (automatic && state.osr_count >= threshold(25)) {  // empty: filled in this cycle, shifted in the next
    tx_stall = tx_stall || tx.empty();
    refill();
    return false;
  }
  const unsigned bits = (instruction & 31u) == 0 ? 32 : instruction & 31u;
  std::uint32_t data;
  if (joins(19)) {
    data = state.osr & low(bits);
    state.osr = bits == 32 ? 0u : state.osr >> bits;
  } else {
    data = bits == 32 ? state.osr : state.osr >> (32 - bits);
    state.osr = bits == 32 ? 0u : state.osr << bits;
  }
  state.osr_count = std::min(state.osr_count + bits, 32u);
  refill();
  const unsigned destination = instruction >> 5 & 7u;
  if (destination == 4)  // pin directions
    write_pins(port.enable, pinctrl & 31u, pinctrl >> 20 & 63u, data);
  else if (destination == 7)  // an instruction
    state.forced = static_cast<std::int32_t>(data & 0xFFFFu);
  else
    give(destination, data, bits, port);
  return true;
}

bool StateMachine::push_pull(std::uint16_t instruction) {
  const bool pulls = (instruction >> 7 & 1u) != 0, conditional = (instruction >> 6 & 1u) != 0,
             blocks = (instruction >> 5 & 1u) != 0;
  if (!pulls) {
    if (conditional && state.isr_count < threshold(20)) return true;
    if (push()) return true;
    if (blocks) return false;
    state.isr = 0;  // dropped
    state.isr_count = 0;
    return true;
  }
  if (conditional && state.osr_count < threshold(25)) return true;
  if (joins(17) && state.osr_count < threshold(25)) return true;  // with autopull a full one is left
  if (tx.empty()) {
    if (blocks) {
      tx_stall = true;
      return false;
    }
    state.osr = state.x;
  } else {
    state.osr = tx.front();
    tx.pop_front();
  }
  state.osr_count = 0;
  return true;
}

std::uint32_t StateMachine::source(unsigned which, const PioPort& port) const {
  switch (which) {
    case 0:
      return pins_in(port);
    case 1:
      return state.x;
    case 2:
      return state.y;
    case 5: {  // STATUS
      const std::size_t level = (execctrl >> 4 & 1u) != 0 ? rx.size() : tx.size();
      return level < (execctrl & 15u) ? 0xFFFFFFFFu : 0u;
    }
    case 6:
      return state.isr;
    case 7:
      return state.osr;
    default:
      return 0;
  }
}

void StateMachine::move(std::uint16_t instruction, PioPort& port) {
  std::uint32_t data = source(instruction & 7u, port);
  const unsigned how = instruction >> 3 & 3u;
  data = how == 1 ? ~data : how == 2 ? reversed(data) : data;
  const unsigned destination = instruction >> 5 & 7u;
  if (destination == 4) {  // an instruction
    state.forced = static_cast<std::int32_t>(data & 0xFFFFu);
  } else if (destination == 7) {
    state.osr = data;
    state.osr_count = 0;
  } else {
    give(destination, data, 0, port);
  }
}

bool StateMachine::interrupt(std::uint16_t instruction, PioPort& port) {
  const std::uint32_t mask = 1u << flag(instruction & 31u);
  if ((instruction >> 6 & 1u) != 0) {
    port.flags &= ~mask;
    return true;
  }
  if ((instruction >> 5 & 1u) == 0) {
    port.flags |= mask;
    return true;
  }
  if (!state.waits_for_flag) {
    port.flags |= mask;
    state.waits_for_flag = true;
    return false;
  }
  if ((port.flags & mask) != 0) return false;
  state.waits_for_flag = false;
  return true;
}

void StateMachine::set(std::uint16_t instruction, PioPort& port) {
  const std::uint32_t data = instruction & 31u;
  switch (instruction >> 5 & 7u) {
    case 0:
      return write_pins(port.out, pinctrl >> 5 & 31u, pinctrl >> 26 & 7u, data);
    case 1:
      state.x = data;
      return;
    case 2:
      state.y = data;
      return;
    case 4:
      return write_pins(port.enable, pinctrl >> 5 & 31u, pinctrl >> 26 & 7u, data);
    default:
      return;
  }
}

StateMachine::Outcome StateMachine::step(PioPort& port, unsigned& cycles) {
  const bool was_forced = forced();
  const auto instruction = static_cast<std::uint16_t>(was_forced ? state.forced : (*program)[state.pc]);
  if (was_forced) state.forced = -1;
  cycles = 1;
  jumped_ = false;
  bool done = true;
  switch (instruction >> 13) {
    case kJmp:
      done = jump(instruction, port);
      break;
    case kWait:
      done = wait(instruction, port);
      break;
    case kIn:
      done = shift_in(instruction, port);
      break;
    case kOut:
      done = shift_out(instruction, port);
      break;
    case kPushPull:
      done = push_pull(instruction);
      break;
    case kMov:
      move(instruction, port);
      break;
    case kIrq:
      done = interrupt(instruction, port);
      break;
    case kSet:
      set(instruction, port);
      break;
  }
  if (instruction >> 13 != kOut) refill();
  side_set(port, instruction);  // behind the rest: of one pin in one cycle it is what is seen
  if (!done) {
    if (was_forced) state.forced = instruction;
    return kStalled;
  }
  if (!forced()) cycles += delay(instruction);  // of one that has EXEC another, that one's is taken instead
  if (!jumped_ && !was_forced)
    state.pc = state.pc == (execctrl >> 12 & 31u) ? execctrl >> 7 & 31u : (state.pc + 1) & 31u;
  return kWent;
}

}  // namespace omnihil::mcu::rp2040
