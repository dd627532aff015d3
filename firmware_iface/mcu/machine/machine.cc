#include "firmware_iface/mcu/machine/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil::mcu {
namespace {

constexpr int kEventsAtOneInstant = 100'000;
constexpr std::uint32_t kNullPointers = 4096;  // Cpu tells of accesses below this address

Memory make_memory(const MachineConfig& config) {
  Memory memory;
  memory.add("ram", config.ram_base, config.ram_bytes, kRam);
  memory.add("flash", config.flash_base, config.flash_bytes, kFlash);
  for (const ExtraMemory& extra : config.memories)
    memory.add(extra.name, extra.base, extra.bytes, extra.kind);
  for (const auto& [name, base] : config.aliases) memory.alias(name, base);
  if (config.flash_at_zero) memory.alias("flash", 0);
  return memory;
}

}  // namespace

Machine::Machine(const MachineConfig& config)
    : config_(config),
      memory_(make_memory(config)),
      cpu_(config_.variant, memory_, *this, config.cpi_scale),
      nvic_(config_.variant),
      clock_(static_cast<std::uint64_t>(std::llround(config.reset_hz))) {
  cpu_.fast_forward = config.fast_forward;
}

void Machine::attach(std::uint32_t base, std::uint32_t size, Peripheral& peripheral) {
  const auto at = std::lower_bound(slots_.begin(), slots_.end(), base,
                                   [](const Slot& slot, std::uint32_t value) { return slot.base < value; });
  slots_.insert(at, {base, size, &peripheral});
  recent_slots_.fill(nullptr);
  eventful_.clear();
  for (const Slot& slot : slots_) {
    if (slot.peripheral->ever_acts()) {
      const Cycles* field = slot.peripheral->next_event_field();
      eventful_.push_back({slot.peripheral, field, field == nullptr});
    }
  }
}

DebugUnit& Machine::debug(DebugListener& listener) {
  if (!debug_) debug_ = std::make_unique<DebugUnit>(*this, listener);
  rare_ = true;
  return *debug_;
}

bool Machine::load(const ElfImage& image, std::vector<std::string>& problems) {
  const std::size_t before = problems.size();
  for (const ElfSegment& segment : image.segments) {
    const MemoryRegion* region = memory_.find(segment.address);
    const std::uint64_t end = std::uint64_t{segment.address} + segment.bytes.size();
    if (!region) {
      problems.push_back(fmt::format("segment at 0x{:08x}: no memory there; flash is 0x{:08x} to 0x{:08x}",
                                     segment.address, config_.flash_base,
                                     config_.flash_base + config_.flash_bytes));
    } else if (end > std::uint64_t{region->base} + region->size) {
      problems.push_back(fmt::format("segment at 0x{:08x}: {} bytes, {} reaches to 0x{:08x}", segment.address,
                                     segment.bytes.size(), region->block->name, region->base + region->size));
    }
  }
  if (problems.size() != before) return false;
  for (const ElfSegment& segment : image.segments) memory_.write(segment.address, segment.bytes);
  occupied_low_ = config_.used_low;
  for (const ElfRange& range : image.occupied) {
    if (range.begin < kNullPointers) occupied_low_.push_back(range);
  }
  std::uint32_t sp = 0, start = 0;
  read_word(config_.boot_address, sp);
  read_word(config_.boot_address + 4, start);
  if (!memory_.find(sp - 4) || sp % 4 != 0) {
    problems.push_back(fmt::format("vector table at 0x{:08x}: initial stack pointer 0x{:08x} is not in RAM",
                                   config_.boot_address, sp));
  }
  if (!memory_.find(start) || !(start & 1)) {
    problems.push_back(
        fmt::format("vector table at 0x{:08x}: reset vector 0x{:08x} is no Thumb code in memory",
                    config_.boot_address + 4, start));
  }
  return problems.size() == before;
}

void Machine::power_on() {
  memory_.clear_ram();
  unknown_.clear();
  unmodelled_index_.clear();
  clock_ = CoreClock(static_cast<std::uint64_t>(std::llround(config_.reset_hz)));
  clock_error_ = 1.0;
  report_ = MachineReport{};
  faulted_at_ = kNever;
  frames_.clear();
  cpu_.statistics = CpuStatistics{};
  now_ = 0;
  accounted_ = 0;
  cpu_.lowest_sp[0] = cpu_.lowest_sp[1] = ~0u;
  reset("power-on");
}

void Machine::request_reset(std::string_view cause) {
  reset_wanted_ = cause;
  rare_ = true;
  reschedule();
}

void Machine::reset(std::string_view cause) {
  reset_wanted_ = cause;
  do_reset();
}

void Machine::note_reset() {
  resets_after_faults_ = faulted_at_ != kNever ? resets_after_faults_ + 1 : 0;
  faulted_at_ = kNever;
  for (std::size_t i = 1; i < report_.resets.size(); ++i) {
    ResetRecord& seen = report_.resets[i];
    if (seen.cause != reset_cause_) continue;
    ++seen.count;
    seen.last = now();
    return;
  }
  report_.resets.push_back({reset_cause_, now(), now()});
}

void Machine::do_reset() {
  account();
  reset_cause_ = reset_wanted_;
  reset_wanted_.clear();
  note_reset();
  cpu_.reg = Registers{};
  cpu_.trap_unaligned = config_.variant.arch == Arch::kV6M;
  nvic_.reset();
  systick_.reset();
  show_at_zero(config_.flash_base);
  vtor_ = config_.boot_address;
  cfsr_ = hfsr_ = mmfar_ = bfar_ = scr_ = shcsr_ = cpacr_ = fpcar_ = demcr_ = 0;
  ccr_ = config_.variant.arch == Arch::kV6M ? 0x208 : 0x200;
  fpccr_ = 0xC0000000u;
  dwt_control_ = 0x40000000u;
  sleeping_ = Sleep::kNo;
  locked_up_ = false;
  frames_.clear();
  nominal_hz_ = config_.reset_hz;
  clock_.change(now(), static_cast<std::uint64_t>(std::llround(nominal_hz_ * clock_error_)));
  for (const Slot& slot : slots_) slot.peripheral->reset();
  apply_control();
  std::uint32_t start = 0;
  read_word(vtor_, cpu_.reg.r[13]);
  read_word(vtor_ + 4, start);
  cpu_.reg.r[13] &= ~3u;
  initial_sp_ = cpu_.reg.r[13];
  cpu_.reg.r[14] = 0xFFFFFFFFu;
  cpu_.reg.r[15] = start & ~1u;
  cpu_.set_attention(false);
  if (!(start & 1)) lock_up();
  if (observer_ != nullptr) observer_->was_reset(now());
  next_event_known_ = armed_known_ = false;
}

void Machine::map_at_zero(std::uint32_t base) {
  zero_wanted_ = base;
  rare_ = true;
  reschedule();
}

void Machine::show_at_zero(std::uint32_t base) {
  zero_wanted_.reset();
  memory_.map_at_zero(base);
  cpu_.memory_changed();
  if (config_.variant.arch == Arch::kV6M && !config_.variant.plus) vtor_ = base;
}

// ---- time

void Machine::set_core_hz(double hz) {
  nominal_hz_ = hz;
  clock_.change(now(), static_cast<std::uint64_t>(std::llround(hz * clock_error_)));
  for (const Slot& slot : slots_) slot.peripheral->clock_changed();
  reschedule();
}

void Machine::set_clock_error(double ratio) {
  clock_error_ = ratio;
  set_core_hz(nominal_hz_);
}

void Machine::reschedule() {
  next_event_known_ = armed_known_ = false;
  ++announced_;
  cpu_.stop_soon();
}

void Machine::event_moved(const Cycles* field, Cycles before) {
  ++announced_;
  cpu_.stop_soon();
  const auto is_it = [field](const Eventful& one) { return one.field == field; };
  if (field == nullptr || std::none_of(armed_.begin(), armed_.end(), is_it)) {
    next_event_known_ = armed_known_ = false;
  } else if (before > next_event_) {  // another one's was the first
    next_event_ = std::min(next_event_, *field);
  } else {
    next_event_known_ = false;
  }
}

void Machine::set_irq(int irq, bool high) {
  nvic_.set_line(irq, high, now());
  if (!nvic_.any_pending()) return;
  cpu_.set_attention(true);
  cpu_.stop_soon();
}

void Machine::look_who_is_armed() {
  armed_.clear();
  for (Eventful& one : eventful_) {
    one.armed = one.armed || one.next() != kNever;
    if (one.armed) armed_.push_back(one);
  }
  armed_known_ = true;
}

Cycles Machine::next_event() {
  if (next_event_known_) return next_event_;
  if (!armed_known_) look_who_is_armed();
  Cycles next = systick_.next_event();
  for (const Eventful& one : armed_) next = std::min(next, one.next());
  next_event_ = next;
  next_event_known_ = true;
  return next;
}

// The next one is found on the way, unless what runs announces that it has moved others'.
void Machine::run_events_due() {
  const Cycles due = static_cast<Cycles>(now_ / kSubcycles);
  for (int rounds = 0; next_event() <= due; ++rounds) {
    const std::uint64_t announced = announced_;
    event_at_ = next_event_;
    if (systick_.advance(event_at_)) pend(kSysTick);
    Cycles next = systick_.next_event();
    for (const Eventful& one : armed_) {
      Cycles at = one.next();
      if (at <= event_at_) {
        one.peripheral->run_events();
        if (rounds > kEventsAtOneInstant) {
          report_unmodelled(one.peripheral->name(),
                            "its next event stays in the past: the machine is stopped");
          lock_up();
          event_at_ = kNever;
          return;
        }
        at = one.next();
      }
      next = std::min(next, at);
    }
    event_at_ = kNever;
    next_event_ = next;
    next_event_known_ = announced == announced_;
  }
}

// ---- running

void Machine::run_until_ns(std::int64_t end_ns) {
  if (debug_) debug_->about_to_run();
  // The clock may change on the way, which moves the cycle that this instant is.
  while (clock_.to_ns(now()) < end_ns) {
    const Cycles end = clock_.from_ns(end_ns);
    const std::uint64_t hz = clock_.hz();
    run_to(end, true);
    if (clock_.hz() == hz) return;
  }
}

void Machine::run_until(Cycles end) { run_to(end, false); }

void Machine::run_to(Cycles end, bool until_clock_changes) {
  const std::uint64_t hz = clock_.hz();
  const std::int64_t end_sub = static_cast<std::int64_t>(end) * kSubcycles;
  while (now_ < end_sub) {
    run_due_events();
    if (rare_) [[unlikely]] {
      if (!reset_wanted_.empty()) {
        do_reset();
        continue;
      }
      if (zero_wanted_) show_at_zero(*zero_wanted_);
    }
    if (until_clock_changes && clock_.hz() != hz) return;
    if (rare_) [[unlikely]] {
      if (debug_ && debug_->halt_if_due()) continue;
      if (locked_up_) {
        now_ =
            static_cast<std::int64_t>(std::max<Cycles>(std::min(end, next_event()), now() + 1)) * kSubcycles;
        continue;
      }
      rare_ = debug_ != nullptr;  // of all that is rare only a debugger stays
    }
    if (sleeping_ != Sleep::kNo) {
      sleep_until(end);
      continue;
    }
    if (nvic_.any_pending()) {
      if (nvic_.best(execution_priority()) != 0) {
        take_exception();
        continue;
      }
    }
    cpu_.set_attention(nvic_.any_pending());
    std::int64_t until = static_cast<std::int64_t>(std::min(end, next_event())) * kSubcycles;
    if (debug_) [[unlikely]]
      until = debug_->limit(now_, until);
    running_ = true;
    const Stop stop = cpu_.run(now_, until);
    running_ = false;
    now_ = cpu_.now();
    if (stop != Stop::kDeadline) handle(stop);
    if (debug_) [[unlikely]]
      debug_->ran(stop);
  }
}

bool Machine::wakes() const {
  if (sleeping_ == Sleep::kForEvent) {
    constexpr std::uint32_t kEventOnPending = 1u << 4;  // SCR.SEVONPEND
    if (cpu_.reg.event || ((scr_ & kEventOnPending) && nvic_.any_pending())) return true;
  }
  if (!nvic_.any_pending()) return false;  // before priorities are worked out
  if (sleeping_ == Sleep::kForEvent) return nvic_.best(execution_priority()) != 0;
  // As if PRIMASK were clear (B1.5.19).
  return nvic_.best(nvic_.execution_priority(false, cpu_.reg.faultmask, cpu_.reg.basepri)) != 0;
}

void Machine::sleep_until(Cycles end) {
  if (wakes()) {
    if (sleeping_ == Sleep::kForEvent) cpu_.reg.event = 0;
    sleeping_ = Sleep::kNo;
    return;
  }
  account();
  const std::int64_t before = now_;
  const Cycles next = std::max<Cycles>(std::min(end, next_event()), now() + 1);
  now_ = static_cast<std::int64_t>(next) * kSubcycles;
  report_.sleep_cycles += static_cast<Cycles>(now_ / kSubcycles - before / kSubcycles);
  accounted_ = now();
}

bool Machine::rom_call() { return cpu_.reg.r[15] - rom_base_ < rom_bytes_ && rom_calls_(cpu_.breakpoint); }

void Machine::handle(Stop stop) {
  switch (stop) {
    case Stop::kWfi:
      sleeping_ = Sleep::kForInterrupt;
      return;
    case Stop::kWfe:
      sleeping_ = Sleep::kForEvent;
      return;
    case Stop::kSvc:
      if (nvic_.group_priority(kSvCall) >= execution_priority()) {
        hfsr_ |= 1u << 30;  // FORCED
        raise({0, 0});
      } else {
        pend(kSvCall);
      }
      return;
    case Stop::kExceptionReturn:
      return_from(cpu_.exception_return);
      return;
    case Stop::kBreakpoint:
      if (visit() || rom_call()) {
      } else if (breakpoint_hook_ && breakpoint_hook_(cpu_.breakpoint)) {
        cpu_.reg.r[15] += 2;
      } else if (debug_ == nullptr || !debug_->takes_breakpoint_instruction()) {
        hfsr_ |= 1u << 31;  // DEBUGEVT
        raise({0, 0});
      }
      return;
    case Stop::kFault:
      raise(cpu_.fault);
      return;
    default:
      return;
  }
}

// ---- what was seen

void Machine::report_unmodelled(std::string_view peripheral, std::string_view what) {
  const std::pair<std::string, std::string> key{peripheral, what};
  const auto [found, is_new] = unmodelled_index_.emplace(key, report_.unmodelled.size());
  if (is_new) report_.unmodelled.push_back({key.first, key.second, cpu_.access_pc(), now(), 0});
  ++report_.unmodelled[found->second].count;
}

void Machine::note_null(std::uint32_t address, bool is_write) {
  for (const ElfRange& range : occupied_low_) {
    if (address - range.begin < range.bytes) return;  // RAM at 0, in which the image has put something
  }
  ++report_.null_access_count;
  const std::uint32_t pc = cpu_.access_pc();
  for (NullAccess& seen : report_.null_accesses) {
    if (seen.pc != pc || seen.address != address || seen.is_write != is_write) continue;
    ++seen.count;
    return;
  }
  if (report_.null_accesses.size() < MachineReport::kMost)
    report_.null_accesses.push_back({pc, address, is_write, 1});
}

void Machine::note_unaligned(std::uint32_t) {
  if (report_.unaligned_count++ == 0) report_.first_unaligned_pc = cpu_.access_pc();
}

MachineReport Machine::report() const {
  MachineReport result = report_;
  const Cycles open = now() - accounted_;  // not yet booked
  (frames_.empty() ? result.thread_cycles : result.exceptions[frames_.back().exception].busy) += open;
  result.lowest_main_sp = cpu_.lowest_sp[0];
  result.lowest_process_sp = cpu_.lowest_sp[1];
  result.main_stack_bytes = cpu_.lowest_sp[0] < initial_sp_ ? initial_sp_ - cpu_.lowest_sp[0] : 0;
  result.instructions = cpu_.statistics.instructions;
  result.skipped_cycles = cpu_.statistics.skipped_subcycles / kSubcycles;
  result.locked_up = locked_up_;
  return result;
}

std::string FaultRecord::text(const std::string& where) const {
  constexpr const char* kNames[] = {"NMI", "HardFault", "MemManage", "BusFault", "UsageFault"};
  const char* name = exception >= 2 && exception <= 6 ? kNames[exception - 2] : "fault";
  return fmt::format("{} at pc 0x{:08x}{}{}, status 0x{:08x}, address 0x{:08x}", name, pc,
                     where.empty() ? "" : " ", where, status, address);
}

}  // namespace omnihil::mcu
