// Registers of the core itself: system control block, FPU control, DWT's cycle counter (DDI 0403E.e B3).
// Those of interrupts are in interrupt_registers.cc.
#include <fmt/format.h>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {
namespace {

enum Offset : std::uint32_t {
  kTypeRegister = 0x004,
  kAuxiliary = 0x008,
  kSysTickFirst = 0x010,
  kSysTickLast = 0x01C,
  kCpuid = 0xD00,
  kIcsr = 0xD04,
  kVtor = 0xD08,
  kAircr = 0xD0C,
  kScr = 0xD10,
  kCcr = 0xD14,
  kShcsr = 0xD24,
  kCfsr = 0xD28,
  kHfsr = 0xD2C,
  kMmfar = 0xD34,
  kBfar = 0xD38,
  kIdFirst = 0xD3C,
  kIdLast = 0xD84,  // with the cache that CCSIDR speaks of
  kCacheSelect = 0xD84,
  kCpacr = 0xD88,
  kMpuType = 0xD90,
  kStir = 0xF00,
  kFpccr = 0xF34,
  kFpcar = 0xF38,
  kFpdscr = 0xF3C,
  kMvfr0 = 0xF40,
  kMvfr1 = 0xF44,
  kMvfr2 = 0xF48,
  kCacheFirst = 0xF50,
  kCacheLast = 0xF78,
};
constexpr std::uint32_t kDwtControl = 0xE0001000, kDwtCycles = 0xE0001004, kDwtLock = 0xE0001FB0;
constexpr std::uint32_t kDhcsr = 0xE000EDF0, kDemcr = 0xE000EDFC;
constexpr std::uint32_t kAircrKey = 0x05FA;

// SHCSR: the bit of each exception's state.
struct HandlerBit {
  int exception, active, pended, enabled;  // -1: has none
};
constexpr HandlerBit kHandlerBits[] = {{kMemManage, 0, 13, 16},  {kBusFault, 1, 14, 17},
                                       {kUsageFault, 3, 12, 18}, {kSvCall, 7, 15, -1},
                                       {kPendSv, 10, -1, -1},    {kSysTick, 11, -1, -1}};

std::uint32_t feature(const Variant& variant, std::uint32_t offset) {
  if (variant.fpu == Fpu::kNone) return 0;
  const bool twice = variant.fpu == Fpu::kDouble;
  if (offset == kMvfr0) return twice ? 0x10110221 : 0x10110021;
  if (offset == kMvfr1) return twice ? 0x12000011 : 0x11000011;
  return variant.fpv5 ? 0x40 : 0;
}

}  // namespace

std::uint32_t Machine::handler_state() const {
  std::uint32_t value = 0;
  for (const HandlerBit& row : kHandlerBits) {
    if (nvic_.active(row.exception)) value |= 1u << row.active;
    if (row.pended >= 0 && nvic_.pending(row.exception)) value |= 1u << row.pended;
    if (row.enabled >= 0 && nvic_.enabled(row.exception)) value |= 1u << row.enabled;
  }
  return value;
}

void Machine::write_handler_control(std::uint32_t value) {
  for (const HandlerBit& row : kHandlerBits) {
    if (row.enabled >= 0) nvic_.set_enabled(row.exception, value >> row.enabled & 1);
    if (row.pended < 0) continue;
    if (value >> row.pended & 1) {
      pend(row.exception);
    } else {
      nvic_.clear_pending(row.exception);
    }
  }
}

std::uint32_t Machine::interrupt_state() const {
  const int waiting = nvic_.best(Nvic::kLowest);
  return cpu_.reg.ipsr | static_cast<std::uint32_t>(waiting) << 12 |
         (nvic_.active_count() <= 1 ? 1u << 11 : 0) | (waiting >= kFirstIrq ? 1u << 22 : 0) |
         (nvic_.pending(kSysTick) ? 1u << 26 : 0) | (nvic_.pending(kPendSv) ? 1u << 28 : 0) |
         (nvic_.pending(kNmi) ? 1u << 31 : 0);
}

void Machine::write_interrupt_control(std::uint32_t value) {
  if (value >> 31) pend(kNmi);
  if (value >> 28 & 1) pend(kPendSv);
  if (value >> 27 & 1) nvic_.clear_pending(kPendSv);
  if (value >> 26 & 1) pend(kSysTick);
  if (value >> 25 & 1) nvic_.clear_pending(kSysTick);
}

void Machine::write_reset_control(std::uint32_t value) {
  if (value >> 16 != kAircrKey) return;
  if (config_.variant.arch != Arch::kV6M) nvic_.set_group(value >> 8 & 7);
  if (value & 4) request_reset("software");
  cpu_.stop_soon();
}

std::uint32_t Machine::read_faults(std::uint32_t offset) const {
  switch (offset) {
    case kCfsr:
      return cfsr_;
    case kHfsr:
      return hfsr_;
    case kMmfar:
      return mmfar_;
    case kBfar:
      return bfar_;
    default:
      return 0;  // DFSR: there is no debugger
  }
}

void Machine::write_faults(std::uint32_t offset, std::uint32_t value) {
  switch (offset & ~3u) {
    case kCfsr:
      cfsr_ &= ~(value << 8 * (offset & 3));
      return;  // write one to clear, by bytes too
    case kHfsr:
      hfsr_ &= ~value;
      return;
    case kMmfar:
      mmfar_ = value;
      return;
    case kBfar:
      bfar_ = value;
      return;
    default:
      return;
  }
}

std::uint32_t Machine::read_fpu(std::uint32_t offset) const {
  switch (offset) {
    case kFpccr:
      return fpccr_;
    case kFpcar:
      return fpcar_;
    case kFpdscr:
      return cpu_.fpdscr;
    default:
      return feature(config_.variant, offset);
  }
}

void Machine::write_fpu(std::uint32_t offset, std::uint32_t value) {
  if (offset == kFpccr) fpccr_ = value & 0xC000003Fu;
  if (offset == kFpcar) fpcar_ = value & ~7u;
  if (offset == kFpdscr) cpu_.fpdscr = value & 0x07C00000u;
  apply_control();
}

std::uint32_t Machine::read_system(std::uint32_t offset) {
  if (offset >= kSysTickFirst && offset <= kSysTickLast) return systick_.read(offset - kSysTickFirst, now());
  if (is_interrupt_register(offset)) return read_interrupts(offset);
  if (offset >= kCfsr && offset <= kBfar) return read_faults(offset);
  if (offset >= kFpccr && offset <= kMvfr2) return read_fpu(offset);
  switch (offset) {
    case kTypeRegister:
      return 7;  // 32 interrupts for each of these, and one more
    case kAuxiliary:
      return 0;
    case kCpuid:
      return config_.variant.cpuid;
    case kIcsr:
      return interrupt_state();
    case kVtor:
      return vtor_;
    case kAircr:
      return 0xFA050000u | nvic_.group() << 8;
    case kScr:
      return scr_;
    case kCcr:
      return ccr_;
    case kShcsr:
      return handler_state();
    case kCpacr:
      return cpacr_;
    case kMpuType:
      return 0;
    default:
      break;
  }
  if (offset >= kIdFirst && offset <= kIdLast) return 0;
  report_unmodelled("system control", fmt::format("0x{:08x} read", 0xE000E000u + offset));
  return 0;
}

bool Machine::write_system(std::uint32_t offset, unsigned bytes, std::uint32_t value) {
  const bool v7 = config_.variant.arch != Arch::kV6M, cached = config_.variant.fpv5;
  if (offset >= kSysTickFirst && offset <= kSysTickLast) {
    systick_.write(offset - kSysTickFirst, value, now());
    cpu_.own_register_changed();
    reschedule();
  } else if (is_interrupt_register(offset)) {
    write_interrupts(offset, bytes, value);
  } else if (offset >= kCfsr && offset < kBfar + 4) {
    write_faults(offset, value);
  } else if (offset >= kFpccr && offset <= kFpdscr) {
    write_fpu(offset, value);
  } else {
    switch (offset) {
      case kIcsr:
        write_interrupt_control(value);
        break;
      case kVtor:
        if (v7) vtor_ = value & ~0x7Fu;
        if (config_.variant.plus) vtor_ = value & ~0xFFu;
        break;
      case kAircr:
        write_reset_control(value);
        break;
      case kScr:
        scr_ = value & 0x16;
        break;
      case kCcr:
        if (v7) ccr_ = value & (cached ? 0x3031Bu : 0x31Bu);
        apply_control();
        break;
      case kShcsr:
        write_handler_control(value);
        break;
      case kCpacr:
        cpacr_ = config_.variant.fpu == Fpu::kNone ? 0 : value & 0x00F00000u;
        apply_control();
        break;
      case kStir:
        pend(kFirstIrq + static_cast<int>(value & 0xFF) % 240);
        break;
      case kAuxiliary:
        break;
      case kCacheSelect:
        return cached;
      default:
        return offset >= kCacheFirst && offset <= kCacheLast && cached;  // there is no cache to maintain
    }
  }
  return true;
}

// Control bits that the core itself looks at.
void Machine::apply_control() {
  const bool v7 = config_.variant.arch != Arch::kV6M;
  cpu_.trap_unaligned = !v7 || (ccr_ >> 3 & 1);
  cpu_.trap_divide_by_zero = v7 && (ccr_ >> 4 & 1);
  const std::uint32_t access = cpacr_ >> 20 & 3;
  cpu_.fp_enabled = access == 3 || (access == 1 && cpu_.reg.privileged());
  cpu_.fp_automatic = fpccr_ >> 31;
  cpu_.fp_changed();
  cpu_.stop_soon();
}

std::uint32_t Machine::read_debug(std::uint32_t address) {
  std::uint32_t traced = 0;
  if (read_trace(address, traced)) return traced;
  switch (address) {
    case kDwtControl:
      return dwt_control_;
    case kDwtCycles:
      if (!(dwt_control_ & 1)) return static_cast<std::uint32_t>(cycle_count_base_);
      return static_cast<std::uint32_t>(now() - cycle_count_base_);
    case kDemcr:
      return demcr_;
    case kDhcsr:
      return 0;  // no debugger
    default:
      break;
  }
  report_unmodelled("debug", fmt::format("0x{:08x} read", address));
  return 0;
}

void Machine::write_debug(std::uint32_t address, std::uint32_t value) {
  switch (address) {
    case kDwtControl: {
      const std::uint32_t count = read_debug(kDwtCycles);
      dwt_control_ = 0x40000000u | (value & 1);
      cycle_count_base_ = dwt_control_ & 1 ? now() - count : count;
      return;
    }
    case kDwtCycles:
      cycle_count_base_ = dwt_control_ & 1 ? now() - value : value;
      return;
    case kDemcr:
      demcr_ = value;
      return;
    case kDwtLock:  // of M7; what it locks is open
      return;
    default:
      report_unmodelled("debug", fmt::format("0x{:08x} written", address));
  }
}

}  // namespace omnihil::mcu
