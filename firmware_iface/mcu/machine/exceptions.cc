// Exception entry, return and faults of the machine (DDI 0403E.e B1.5.6 to B1.5.15).
#include <algorithm>
#include <span>
#include <utility>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {
namespace {

constexpr int kReturnCycles = 10, kTailChainCycles = 6;
constexpr std::uint32_t kStackAlign = 1u << 9, kNonBaseThread = 1u << 0;
constexpr std::uint32_t kAlignedBit = 1u << 9;  // of the stacked xPSR
constexpr int kBasicWords = 8, kFpWords = 18;
constexpr int kFpStored = 17;  // the last one is reserved

}  // namespace

void Machine::pend(int e) {
  nvic_.set_pending(e, now());
  cpu_.set_attention(true);
  cpu_.stop_soon();
}

int Machine::execution_priority() const {
  return nvic_.execution_priority(cpu_.reg.primask, cpu_.reg.faultmask, cpu_.reg.basepri);
}

// Time since the last change goes to what has been executing.
void Machine::account() {
  const Cycles at = now(), spent = at - accounted_;
  accounted_ = at;
  if (frames_.empty()) {
    report_.thread_cycles += spent;
  } else {
    frames_.back().load->busy += spent;
  }
}

bool Machine::push_frame() {
  Registers& R = cpu_.reg;
  const bool fp = R.control & kFpContextActive;
  const std::uint32_t bytes = 4 * (kBasicWords + (fp ? kFpWords : 0));
  const bool align = (ccr_ & kStackAlign) || fp;
  const std::uint32_t shifted = align ? R.r[13] & 4 : 0;
  const std::uint32_t frame = (R.r[13] - bytes) & (align ? ~7u : ~3u);
  const std::uint32_t xpsr = (cpu_.xpsr() & ~kAlignedBit) | (shifted ? kAlignedBit : 0);
  std::uint32_t words[kBasicWords + kFpStored] = {R.r[0],  R.r[1],  R.r[2],  R.r[3],
                                                  R.r[12], R.r[14], R.r[15], xpsr};
  R.r[13] = frame;
  if (fp) {
    std::copy_n(R.s, 16, words + kBasicWords);
    words[kBasicWords + 16] = R.fpscr;
    fpcar_ = frame + 32;
  }
  const bool stored = write_words(frame, std::span(words).first(fp ? kBasicWords + kFpStored : kBasicWords));
  const int which = R.uses_psp() ? 1 : 0;
  cpu_.lowest_sp[which] = std::min(cpu_.lowest_sp[which], frame);
  return stored;
}

void Machine::take_exception() {
  account();
  Registers& R = cpu_.reg;
  const bool fp = R.control & kFpContextActive, psp = R.uses_psp();
  const std::uint32_t exception_return =
      0xFFFFFFE1u | (fp ? 0 : 0x10) | (R.ipsr == 0 ? 8 : 0) | (psp ? 4 : 0);
  if (!push_frame()) {  // the fault joins what is pending
    const int before = execution_priority();
    cfsr_ |= kStackingBus;
    const bool taken = nvic_.enabled(kBusFault) && nvic_.group_priority(kBusFault) < before;
    if (!taken) hfsr_ |= 1u << 30;
    pend(taken ? kBusFault : kHardFault);
  }
  now_ += cpu_.subcycles(config_.variant.exception_entry_cycles);
  run_due_events();  // a late arrival takes this entry over
  if (psp) std::swap(R.r[13], R.other_sp);
  R.control &= kUnprivileged;
  enter_handler(exception_return);
}

// Stacking is done (or was spared): the most urgent pending exception starts.
void Machine::enter_handler(std::uint32_t exception_return) {
  Registers& R = cpu_.reg;
  account();
  const int e = nvic_.best(execution_priority());
  const Cycles at = now();
  InterruptLoad& load = report_.exceptions[e];
  ++load.count;
  load.longest_latency = std::max(load.longest_latency, at - std::min(at, nvic_.pended_at(e)));
  frames_.push_back({e, at, &load});
  if (observer_ != nullptr) observer_->exception_begins(e, at);
  nvic_.activate(e);
  R.ipsr = static_cast<std::uint32_t>(e);
  R.r[14] = exception_return;
  R.exclusive = 0;
  R.event = 1;
  std::uint32_t vector = 0;
  if (!read_word(vtor_ + 4 * static_cast<std::uint32_t>(e), vector)) {
    hfsr_ |= 2;  // VECTTBL
    if (e == kHardFault) {
      lock_up();
    } else {
      pend(kHardFault);
    }
  }
  R.r[15] = vector & ~1u;
  if (!(vector & 1)) raise({kInvalidState, 0});
}

bool Machine::pop_frame(std::uint32_t exception_return) {
  Registers& R = cpu_.reg;
  const bool thread = exception_return & 8, fp = !(exception_return & 0x10);
  if (thread && (exception_return & 4)) std::swap(R.r[13], R.other_sp);
  const std::uint32_t frame = R.r[13];
  std::uint32_t basic[kBasicWords + kFpWords] = {};
  const std::size_t bytes = 4 * (kBasicWords + (fp ? kFpWords : 0));
  const bool loaded = frame % 4 == 0 && memory_.read(frame, {reinterpret_cast<std::uint8_t*>(basic), bytes});
  R.control &= kUnprivileged;
  if (thread && (exception_return & 4)) R.control |= kUseProcessStack;
  if (!loaded) {
    R.ipsr = thread ? 0 : R.ipsr;
    return false;
  }
  for (std::size_t i = 0; i < 4; ++i) R.r[i] = basic[i];
  R.r[12] = basic[4];
  R.r[14] = basic[5];
  R.r[15] = basic[6] & ~1u;
  const std::uint32_t xpsr = basic[7];
  R.set_apsr(xpsr);
  R.ipsr = xpsr & 0x1FF;
  if (fp) {
    std::copy_n(basic + kBasicWords, 16, R.s);
    R.fpscr = basic[kBasicWords + 16];
    R.control |= kFpContextActive;
  }
  R.r[13] = frame + 4u * (kBasicWords + (fp ? kFpWords : 0)) + (xpsr & kAlignedBit ? 4 : 0);
  cpu_.resume_it(R.r[15], it_of_xpsr(xpsr));
  return true;
}

void Machine::return_from(std::uint32_t exception_return) {
  Registers& R = cpu_.reg;
  const int e = static_cast<int>(R.ipsr);
  const std::uint32_t form = exception_return & 15;
  const bool to_thread = form == 9 || form == 13;
  const bool known = (form == 1 || to_thread) && (exception_return | 0x1F) == 0xFFFFFFFFu &&
                     (config_.variant.fpu != Fpu::kNone || (exception_return & 0x10));
  const bool nested = nvic_.active_count() > 1;
  const bool allowed = to_thread ? !nested || (ccr_ & kNonBaseThread) : nested;
  account();
  if (!frames_.empty() && frames_.back().exception == e) {
    InterruptLoad& load = *frames_.back().load;
    load.longest = std::max(load.longest, now() - frames_.back().entered);
    frames_.pop_back();
  }
  if (observer_ != nullptr) observer_->exception_ends(e, now());
  const bool was_active = nvic_.active(e);
  nvic_.deactivate(e, now());
  if (e != kNmi) R.faultmask = 0;
  if (!known || !allowed || !was_active) {
    R.r[14] = 0xF0000000u | exception_return;
    raise({kInvalidReturn, 0});
    return;
  }
  R.exclusive = 0;
  R.event = 1;
  if (nvic_.any_pending() &&
      nvic_.best(execution_priority()) != 0) {  // tail-chain: the frame stays where it is
    now_ += cpu_.subcycles(kTailChainCycles);
    run_due_events();
    enter_handler(exception_return);
    return;
  }
  now_ += cpu_.subcycles(kReturnCycles);
  account();
  if (!pop_frame(exception_return)) {
    raise({kUnstackingBus, 0});
    return;
  }
  if (to_thread != (R.ipsr == 0)) raise({kInvalidReturn, 0});
  if (to_thread && (scr_ & 2) && nvic_.active_count() == 0) sleeping_ = Sleep::kForInterrupt;  // SLEEPONEXIT
}

// A synchronous fault of the instruction at r[15]; no bits: one that has no handler but HardFault.
void Machine::raise(const Fault& fault) {
  ++report_.fault_count;
  if (debug_) debug_->note_fault(fault);
  cfsr_ |= fault.status;
  if (fault.status & kBusAddressValid) bfar_ = fault.address;
  int e = kHardFault;
  if (fault.status & 0xFFFF0000u) e = kUsageFault;
  if (fault.status & 0xFF00u) e = kBusFault;
  if (fault.status & 0xFFu) e = kMemManage;
  const int priority = execution_priority();
  const bool configurable = e != kHardFault && config_.variant.arch != Arch::kV6M;
  if (configurable && !(nvic_.enabled(e) && nvic_.group_priority(e) < priority)) {
    hfsr_ |= 1u << 30;  // FORCED
    e = kHardFault;
  }
  if (!configurable) e = kHardFault;
  note_fault(e, fault);
  if (e == kHardFault && priority <= -1) {
    lock_up();
    return;
  }
  pend(e);
}

void Machine::note_fault(int exception, const Fault& fault) {
  faulted_at_ = now();
  const std::uint32_t pc = cpu_.reg.r[15];
  for (FaultRecord& seen : report_.faults) {
    if (seen.exception != exception || seen.pc != pc || seen.status != fault.status ||
        seen.address != fault.address)
      continue;
    ++seen.count;
    return;
  }
  if (report_.faults.size() < MachineReport::kMost)
    report_.faults.push_back({exception, fault.status, fault.address, pc, now()});
}

void Machine::lock_up() {
  locked_up_ = rare_ = true;
  report_.lock_up_pc = cpu_.reg.r[15];
}

}  // namespace omnihil::mcu
