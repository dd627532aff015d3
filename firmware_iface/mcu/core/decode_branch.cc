// 32-bit branches, system registers, barriers and hints (DDI 0403E.e A5.3.4, B5).
#include "firmware_iface/mcu/core/decode.h"

namespace omnihil::mcu {
namespace {

bool has_special_register(const DecodeContext& at, std::uint32_t sysm) {
  if (sysm <= 3 || (sysm >= 5 && sysm <= 9) || sysm == 16 || sysm == 20) return true;
  return at.v7() && sysm >= 17 && sysm <= 19;
}

bool miscellaneous(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const std::uint32_t sysm = g & 255;
  if ((h & 0xFFF0) == 0xF380 && (g & 0xF300) == 0x8000) {  // MSR
    const std::uint32_t mask = bits(g, 11, 10);
    op.n = u8(h & 15);
    op.a = u8(mask << 2);
    op.imm = sysm;
    op.code = kMsr;
    if (bad(op.n) || !has_special_register(at, sysm) || mask == 0) return false;
    return mask == 2 || (sysm <= 3 && at.dsp());
  }
  if (h == 0xF3AF && (g & 0xFF00) == 0x8000) {  // hints
    constexpr Code kHints[] = {kNop, kNop, kWfe, kWfi, kSev};
    op.code = sysm < 5 ? kHints[sysm] : kNop;
    return true;
  }
  if (h == 0xF3BF && (g & 0xFF00) == 0x8F00) {
    const std::uint32_t which = bits(g, 7, 4);
    op.code = which == 2 ? kClrex : kBarrier;
    return (which == 2 && (g & 15) == 15) || (which >= 4 && which <= 6);
  }
  if (h == 0xF3EF && (g & 0xF000) == 0x8000) {  // MRS
    op.d = u8(bits(g, 11, 8));
    op.imm = sysm;
    op.code = kMrs;
    return !bad(op.d) && has_special_register(at, sysm);
  }
  return false;
}

}  // namespace

bool decode_branch_misc(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const std::uint32_t sign = bits(h, 10, 10), j1 = bits(g, 13, 13), j2 = bits(g, 11, 11);
  const auto extended = [&](std::uint32_t value, int width) {
    return at.pc + 4 +
           static_cast<std::uint32_t>(static_cast<std::int32_t>(value << (32 - width)) >> (32 - width));
  };
  if (!bit(g, 12)) {
    if (bit(g, 14)) return false;
    if (bits(h, 9, 7) == 7) return miscellaneous(at, h, g, op);
    op.a = u8(bits(h, 9, 6));
    op.imm = extended((g & 0x7FF) << 1 | (h & 0x3F) << 12 | j1 << 18 | j2 << 19 | sign << 20, 21);
    op.code = kBcond;
    return !at.in_it();
  }
  const std::uint32_t i1 = (j1 ^ sign) ^ 1, i2 = (j2 ^ sign) ^ 1;
  op.imm = extended((g & 0x7FF) << 1 | (h & 0x3FF) << 12 | i2 << 22 | i1 << 23 | sign << 24, 25);
  op.code = bit(g, 14) ? kBl : kB;
  return !at.mid_it();
}

}  // namespace omnihil::mcu
