// MRS, MSR and CPS (DDI 0403E.e B5.2).
#include <utility>

#include "firmware_iface/mcu/core/cpu.h"

namespace omnihil::mcu {
namespace {

enum Sysm : std::uint32_t {
  kMsp = 8,
  kPsp = 9,
  kPrimask = 16,
  kBasepri = 17,
  kBasepriMax = 18,
  kFaultmask = 19,
  kControl = 20
};

}  // namespace

std::uint32_t Cpu::special(std::uint32_t sysm) const {
  if (sysm < 8) {
    const std::uint32_t flags = reg.apsr() & (variant_.arch == Arch::kV7EM ? 0xF80F0000u : 0xF8000000u);
    return (sysm & 4 ? 0 : flags) | (sysm & 1 ? reg.ipsr : 0);  // EPSR reads as 0
  }
  if (sysm == kControl) return reg.control;
  if (!reg.privileged()) return 0;
  switch (sysm) {
    case kMsp:
      return reg.msp();
    case kPsp:
      return reg.psp();
    case kPrimask:
      return reg.primask;
    case kBasepri:
    case kBasepriMax:
      return reg.basepri;
    default:
      return reg.faultmask;
  }
}

void Cpu::write_special(std::uint32_t sysm, unsigned mask, std::uint32_t value) {
  if (sysm < 8) {
    if (sysm & 4) return;
    if (mask & 8) {
      reg.set_nzcv(value);
      if (variant_.arch != Arch::kV6M) reg.q = value >> 27 & 1;
    }
    if (mask & 4) reg.ge = value >> 16 & 15;
    return;
  }
  if (!reg.privileged()) return;
  const std::uint32_t priority = value & (0xFF00u >> variant_.priority_bits & 0xFF);
  switch (sysm) {
    case kMsp:
    case kPsp:
      (reg.uses_psp() == (sysm == kPsp) ? reg.r[13] : reg.other_sp) = value & ~3u;
      return;
    case kPrimask:
      reg.primask = value & 1;
      break;
    case kBasepri:
      reg.basepri = priority;
      break;
    case kBasepriMax:
      if (priority != 0 && (priority < reg.basepri || reg.basepri == 0)) reg.basepri = priority;
      break;
    case kFaultmask:
      if (reg.ipsr != 2 && reg.ipsr != 3) reg.faultmask = value & 1;
      break;
    default: {
      const bool psp = reg.uses_psp();
      std::uint32_t settable = kUseProcessStack;
      if (variant_.arch != Arch::kV6M || variant_.plus) settable |= kUnprivileged;
      if (variant_.fpu != Fpu::kNone) settable |= kFpContextActive;
      if (reg.ipsr != 0) settable &= ~static_cast<std::uint32_t>(kUseProcessStack);
      reg.control = (reg.control & ~settable) | (value & settable);
      fp_changed();
      if (reg.uses_psp() != psp) std::swap(reg.r[13], reg.other_sp);
      return;
    }
  }
  if (attention_) stop_requested_ = true;
}

void Cpu::change_masks(std::uint32_t imm) {
  if (!reg.privileged()) return;
  const std::uint32_t disable = imm >> 4 & 1;
  if (imm & 2) reg.primask = disable;
  if ((imm & 1) && reg.ipsr != 2 && reg.ipsr != 3) reg.faultmask = disable;
  if (attention_) stop_requested_ = true;
}

}  // namespace omnihil::mcu
