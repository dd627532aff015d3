// One state machine of a PIO: its registers, FIFOs and instruction set.
//
//   StateMachine sm;  unsigned cycles = 0;
//   sm.program = &words;  sm.step(port, cycles);      // one instruction or one cycle of a stall
//
// Law: RP2040 datasheet §3.2 to §3.5. Pins and flags are its PIO's (PioPort). Of two writers to one pin in one cycle the
// machine of the higher number wins, as there.
#pragma once
#include <array>
#include <cstdint>
#include <deque>

namespace omnihil::mcu::rp2040 {

// What the four machines share.
struct PioPort {
  std::uint32_t inputs = 0;           // pins as they are
  std::uint32_t out = 0, enable = 0;  // what the machines have driven
  std::uint32_t flags = 0;            // IRQ
};

class StateMachine {
 public:
  enum Outcome : std::uint8_t { kWent, kStalled };
  std::uint32_t clkdiv = 0x00010000, execctrl = 0x0001F000, shiftctrl = 0x000C0000, pinctrl = 0x14000000;
  std::array<std::uint16_t, 32>* program = nullptr;
  unsigned number = 0;
  bool enabled = false;
  std::deque<std::uint32_t> tx, rx;
  bool rx_stall = false, tx_stall = false;  // of FDEBUG, latched

  // The machine's part that a repeated loop comes back to.
  struct State {
    std::uint32_t x = 0, y = 0, isr = 0, osr = 0;
    std::uint32_t isr_count = 0, osr_count = 32;
    std::uint8_t pc = 0;
    std::int32_t forced = -1;  // by INSTR, OUT EXEC or MOV EXEC
    bool waits_for_flag = false;
    bool operator==(const State&) const = default;
  };
  State state;

  // Runs what stands at pc; `cycles`: of it with its delay. A stall is one cycle and leaves pc.
  Outcome step(PioPort& port, unsigned& cycles);
  void restart();
  void force(std::uint16_t instruction) { state.forced = instruction; }
  bool forced() const { return state.forced >= 0; }
  std::size_t tx_depth() const { return joins(30) ? 8 : joins(31) ? 0 : 4; }
  std::size_t rx_depth() const { return joins(31) ? 8 : joins(30) ? 0 : 4; }
  // Whether its program may do what is seen outside, but for its FIFOs.
  bool acts_outside() const;
  // One of its cycles, in 256ths of one of clk_sys.
  std::uint32_t period() const {
    const std::uint32_t whole = clkdiv >> 16;
    return (whole == 0 ? 0x10000u : whole) << 8 | (clkdiv >> 8 & 0xFFu);
  }

 private:
  bool joins(unsigned at) const { return (shiftctrl >> at & 1u) != 0; }
  unsigned threshold(unsigned at) const {
    const unsigned bits = shiftctrl >> at & 31u;
    return bits == 0 ? 32 : bits;
  }
  std::uint32_t pins_in(const PioPort& port) const;
  void write_pins(std::uint32_t& word, unsigned base, unsigned count, std::uint32_t value) const;
  void side_set(PioPort& port, std::uint16_t instruction) const;
  unsigned delay(std::uint16_t instruction) const;
  bool condition(unsigned which, const PioPort& port);
  std::uint32_t source(unsigned which, const PioPort& port) const;
  bool jump(std::uint16_t instruction, const PioPort& port);
  bool wait(std::uint16_t instruction, PioPort& port);
  bool shift_in(std::uint16_t instruction, const PioPort& port);
  bool shift_out(std::uint16_t instruction, PioPort& port);
  bool push_pull(std::uint16_t instruction);
  void give(unsigned destination, std::uint32_t data, unsigned bits, PioPort& port);
  void move(std::uint16_t instruction, PioPort& port);
  bool interrupt(std::uint16_t instruction, PioPort& port);
  void set(std::uint16_t instruction, PioPort& port);
  bool push();
  void refill();
  unsigned flag(unsigned index) const {
    return (index & 0x10u) != 0 ? (index & 4u) | ((index + number) & 3u) : index & 7u;
  }

  bool jumped_ = false;
};

}  // namespace omnihil::mcu::rp2040
