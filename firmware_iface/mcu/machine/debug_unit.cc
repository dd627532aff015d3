#include "firmware_iface/mcu/machine/debug_unit.h"

#include <algorithm>
#include <utility>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {

std::uint32_t DebugUnit::pc() const { return machine_.cpu().reg.r[15]; }
int DebugUnit::level() const { return static_cast<int>(machine_.nvic().active_count()); }

void DebugUnit::set_breakpoints(std::vector<std::uint32_t> addresses) {
  breakpoints_ = std::move(addresses);
  machine_.cpu().set_halts(breakpoints_);
}

void DebugUnit::set_watchpoints(std::vector<AccessWatch> watches) {
  machine_.cpu().set_watches(std::move(watches));
}

void DebugUnit::step() {
  stepping_ = true;
  step_level_ = level();
}

bool DebugUnit::halt_if_due() {
  if (!due_ && !asked_) return false;
  const Halt halt = due_ ? *due_ : Halt{};
  due_.reset();
  asked_ = stepping_ = false;
  passing_.reset();
  const std::uint32_t at = pc();
  listener_.halted(*this, halt);
  if (halt.cause == HaltCause::kInstruction && pc() == at) {  // goes on behind BKPT
    machine_.cpu().reg.r[15] += 2;
    if (stepping_) due_ = Halt{HaltCause::kStep};
  }
  if (std::ranges::find(breakpoints_, pc()) != breakpoints_.end()) passing_ = pc();
  return true;
}

std::int64_t DebugUnit::limit(std::int64_t now, std::int64_t end) {
  if (passing_ && *passing_ == pc()) {
    std::vector<std::uint32_t> others = breakpoints_;
    std::erase(others, *passing_);
    machine_.cpu().set_halts(std::move(others));
    unmarked_ = true;
  }
  alone_ = stepping_ && level() <= step_level_;
  return alone_ || unmarked_ ? std::min(now + 1, end) : end;
}

void DebugUnit::ran(Stop stop) {
  if (unmarked_) {
    machine_.cpu().set_halts(breakpoints_);
    unmarked_ = false;
    passing_.reset();
  }
  const std::optional<AccessHit> hit = machine_.cpu().take_hit();
  if (due_) return;
  if (hit) {
    due_ = Halt{HaltCause::kWatchpoint, *hit};
  } else if (stop == Stop::kHalted) {
    due_ = Halt{HaltCause::kBreakpoint};
  } else if (alone_) {
    due_ = Halt{HaltCause::kStep};
  }
}

void DebugUnit::note_fault(const Fault& fault) {
  if (catching_ && !due_) due_ = Halt{HaltCause::kFault, {}, fault.status};
}

bool DebugUnit::takes_breakpoint_instruction() {
  if (!catching_) return false;
  due_ = Halt{HaltCause::kInstruction};
  return true;
}

}  // namespace omnihil::mcu
