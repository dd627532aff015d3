// What a debugger does to a machine: it halts it at an instruction, at an access or after a step, and looks at it
// while it stands.
//
//   DebugUnit& debug = machine.debug(listener);
//   debug.set_breakpoints({0x08000200});
//   machine.run_until(1'000'000);              // listener.halted() is called within; when it returns, the machine goes on
//
// Nothing of the image is changed. A machine halts between two instructions, before an exception that is due there is
// taken; that it was halted changes no result. A step runs one instruction at the level at which it began: exceptions
// that come in are handled whole, unless they halt themselves. Accesses of the core alone are watched, not those of
// DMA, of exception entry and return, and of constants beside the code.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/core/cpu.h"

namespace omnihil::mcu {

class DebugUnit;
class Machine;

enum class HaltCause : std::uint8_t { kAsked, kStep, kBreakpoint, kWatchpoint, kInstruction, kFault };
struct Halt {
  HaltCause cause = HaltCause::kAsked;
  AccessHit hit{};           // kWatchpoint
  std::uint32_t status = 0;  // kFault: as in CFSR; 0: none of its causes
};

class DebugListener {
 public:
  virtual ~DebugListener() = default;
  virtual void about_to_run(DebugUnit&) {}  // once per Machine::run_until_ns()
  virtual void halted(DebugUnit&, const Halt&) = 0;
};

class DebugUnit {
 public:
  DebugUnit(Machine& machine, DebugListener& listener) : machine_(machine), listener_(listener) {}
  Machine& machine() { return machine_; }

  // Of the listener.
  void ask() { asked_ = true; }
  void set_breakpoints(std::vector<std::uint32_t> addresses);
  void set_watchpoints(std::vector<AccessWatch> watches);
  void step();  // the next time that it goes on
  void forget_step() { stepping_ = alone_ = false; }
  // Faults and BKPT halt instead of going to their handlers at once. Off at first.
  void set_catching(bool on) { catching_ = on; }

  // Of the machine.
  void about_to_run() { listener_.about_to_run(*this); }
  bool halt_if_due();
  std::int64_t limit(std::int64_t now, std::int64_t end);  // of the run that follows, in subcycles
  void ran(Stop stop);
  void note_fault(const Fault& fault);
  bool takes_breakpoint_instruction();

 private:
  std::uint32_t pc() const;
  int level() const;

  Machine& machine_;
  DebugListener& listener_;
  std::vector<std::uint32_t> breakpoints_;
  std::optional<Halt> due_;
  std::optional<std::uint32_t>
      passing_;  // the breakpoint that it went on from, until its instruction has run
  bool asked_ = false, catching_ = false, stepping_ = false, alone_ = false, unmarked_ = false;
  int step_level_ = 0;
};

}  // namespace omnihil::mcu
