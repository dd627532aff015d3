// Floating point: FPv4-SP and FPv5 (DDI 0403E.e A6). Double registers are named by the S register of their
// low half.
#include "firmware_iface/mcu/core/decode.h"

namespace omnihil::mcu {
namespace {

struct FpRegisters {
  std::uint32_t d, n, m;             // as S registers, or as the low half of D registers
  std::uint32_t single_d, single_m;  // the same fields read as S registers
  bool exist;
};

FpRegisters registers_of(std::uint32_t h, std::uint32_t g, bool wide) {
  FpRegisters r;
  r.single_d = bits(g, 15, 12) << 1 | bits(h, 6, 6);
  r.single_m = (g & 15) << 1 | bits(g, 5, 5);
  const std::uint32_t single_n = (h & 15) << 1 | bits(g, 7, 7);
  r.d = wide ? bits(g, 15, 12) * 2 : r.single_d;
  r.n = wide ? (h & 15) * 2 : single_n;
  r.m = wide ? (g & 15) * 2 : r.single_m;
  r.exist = true;
  return r;
}

// OP##F32 or OP##F64, which stand next to each other.
Code sized(Code single, bool wide) { return offset(single, wide ? 1 : 0); }

// VFPExpandImm, upper word; a double's lower word is 0.
std::uint32_t expand_fp(std::uint32_t imm8, bool wide) {
  const std::uint32_t sign = imm8 >> 7, b = imm8 >> 6 & 1, rest = imm8 & 0x3F;
  if (wide) return sign << 31 | (b ? 0x3FC00000u : 0x40000000u) | rest << 16;
  return sign << 31 | (b ? 0x3E000000u : 0x40000000u) | rest << 19;
}

bool fixed_point(std::uint32_t h, std::uint32_t g, bool wide, const FpRegisters& r, Op& op) {
  const bool to_fixed = bit(h, 2), is_unsigned = bit(h, 0), word = bit(g, 7);
  const std::uint32_t size = word ? 32 : 16, imm5 = (g & 15) << 1 | bits(g, 5, 5);
  op.d = u8(r.d);
  op.imm = size - imm5;
  op.a = u8((is_unsigned ? 1 : 0) | (word ? 2 : 0));
  op.code = sized(to_fixed ? kVcvtToFixedF32 : kVcvtFromFixedF32, wide);
  return imm5 <= size && !(wide && bit(h, 6));
}

// a of VCVT to an integer: 1 unsigned; the rest is the rounding, see FpRounding.
bool conversion(const DecodeContext& at, std::uint32_t h, std::uint32_t g, bool wide, const FpRegisters& r,
                Op& op) {
  const std::uint32_t which = h & 15;
  const bool seven = bit(g, 7), d_ok = !wide || !bit(h, 6), m_ok = !wide || !bit(g, 5);
  op.d = u8(r.d);
  op.m = u8(r.m);
  switch (which) {
    case 0:
      op.code = sized(seven ? kVabsF32 : kVmovF32, wide);
      return d_ok && m_ok;
    case 1:
      op.code = sized(seven ? kVsqrtF32 : kVnegF32, wide);
      return d_ok && m_ok;
    case 2:
    case 3:  // half precision; the double form is FPv5's
      op.a = seven ? 16 : 0;
      if (which == 2) {
        op.m = u8(r.single_m);
        op.code = sized(kVcvtFromHalfF32, wide);
        return d_ok;
      }
      op.d = u8(r.single_d);
      op.code = sized(kVcvtToHalfF32, wide);
      return m_ok;
    case 4:
      op.code = sized(kVcmpF32, wide);
      return d_ok && m_ok;
    case 5:
      op.code = sized(kVcmpZeroF32, wide);
      return d_ok && (g & 0x2F) == 0;
    case 6:
      op.a = seven ? 5 : 4;  // VRINTZ, VRINTR
      op.code = sized(kVrintF32, wide);
      return at.variant.fpv5 && d_ok && m_ok;
    case 7:
      if (seven) {
        op.d = u8(wide ? r.single_d : bits(g, 15, 12) * 2);
        op.code = wide ? kVcvtF32F64 : kVcvtF64F32;
        return at.variant.fpu == Fpu::kDouble && (wide ? m_ok : !bit(h, 6));
      }
      op.a = 4;  // VRINTX
      op.code = sized(kVrintF32, wide);
      return at.variant.fpv5 && d_ok && m_ok;
    case 8:
      op.m = u8(r.single_m);
      op.a = seven ? 0 : 1;
      op.code = sized(kVcvtFromIntF32, wide);
      return d_ok;
    case 12:
    case 13:
      op.d = u8(r.single_d);
      op.a = u8((which == 12 ? 1 : 0) | (seven ? 5 : 4) << 1);
      op.code = sized(kVcvtToIntF32, wide);
      return m_ok;
    case 10:
    case 11:
    case 14:
    case 15:
      return fixed_point(h, g, wide, r, op);
    default:
      return false;
  }
}

bool arithmetic(const DecodeContext& at, std::uint32_t h, std::uint32_t g, bool wide, Op& op) {
  if (wide && at.variant.fpu != Fpu::kDouble) return false;
  const FpRegisters r = registers_of(h, g, wide);
  const bool six = bit(g, 6);
  if ((h & 0xB0) == 0xB0) {
    if (six) return conversion(at, h, g, wide, r, op);
    op.d = u8(r.d);
    op.imm = expand_fp((h & 15) << 4 | (g & 15), wide);
    op.code = sized(kVmovImmF32, wide);
    return (g & 0xA0) == 0 && !(wide && bit(h, 6));
  }
  op.d = u8(r.d);
  op.n = u8(r.n);
  op.m = u8(r.m);
  if (wide && (bit(h, 6) || bit(g, 7) || bit(g, 5))) return false;
  const std::uint32_t row = (bit(h, 7) ? 4u : 0) | bits(h, 5, 4);
  constexpr Code kOps[7][2] = {{kVmlaF32, kVmlsF32}, {kVnmlsF32, kVnmlaF32}, {kVmulF32, kVnmulF32},
                               {kVaddF32, kVsubF32}, {kVdivF32, kUndefined}, {kVfnmsF32, kVfnmaF32},
                               {kVfmaF32, kVfmsF32}};
  const Code code = kOps[row][six ? 1 : 0];
  op.code = sized(code, wide);
  return code != kUndefined;
}

bool fpv5(const DecodeContext& at, std::uint32_t h, std::uint32_t g, bool wide, Op& op) {
  if (!at.variant.fpv5 || (wide && at.variant.fpu != Fpu::kDouble) || at.in_it() || bit(g, 4)) return false;
  const FpRegisters r = registers_of(h, g, wide);
  const bool d_ok = !wide || !bit(h, 6), n_ok = !wide || !bit(g, 7), m_ok = !wide || !bit(g, 5);
  op.d = u8(r.d);
  op.n = u8(r.n);
  op.m = u8(r.m);
  if (!bit(h, 7)) {  // VSEL: EQ, VS, GE, GT
    constexpr std::uint8_t kConditions[] = {0, 6, 10, 12};
    op.a = kConditions[bits(h, 5, 4)];
    op.code = sized(kVselF32, wide);
    return !bit(g, 6) && d_ok && n_ok && m_ok;
  }
  if (bits(h, 5, 4) == 0) {
    op.code = sized(bit(g, 6) ? kVminnmF32 : kVmaxnmF32, wide);
    return d_ok && n_ok && m_ok;
  }
  if (bits(h, 5, 3) != 7 || !bit(g, 6) || !m_ok) return false;
  const std::uint32_t direction = h & 3;  // to nearest with ties away, to nearest even, up, down
  if (!bit(h, 2)) {
    op.a = u8(direction);
    op.code = sized(kVrintF32, wide);
    return d_ok && !bit(g, 7);
  }
  op.d = u8(r.single_d);
  op.a = u8((bit(g, 7) ? 0 : 1) | direction << 1);
  op.code = sized(kVcvtToIntF32, wide);
  return true;
}

bool list_access(const DecodeContext& at, std::uint32_t h, std::uint32_t g, bool wide, Op& op) {
  const bool before = bit(h, 8), up = bit(h, 7), back = bit(h, 5), load = bit(h, 4);
  op.n = u8(h & 15);
  op.d = u8(registers_of(h, g, wide).d);
  if (wide && bit(h, 6)) return false;
  if (before && !back) {  // VLDR, VSTR
    op.imm = up ? (g & 255) * 4 : 0u - (g & 255) * 4;
    op.code = wide ? (load ? kVldrD : kVstrD) : (load ? kVldrS : kVstrS);
    if (op.n != 15) return true;
    op.imm += at.literal_base();
    op.a = 1;
    return load;
  }
  if (before == up) return false;
  op.imm = g & 255;                         // words the address moves by
  op.m = u8(wide ? op.imm & ~1u : op.imm);  // words transferred
  op.a = u8((back ? 1 : 0) | (before ? 2 : 0));
  op.code = load ? kVldm : kVstm;
  return op.n != 15 && op.m != 0 && op.d + op.m <= 32 && op.imm <= 33;
}

bool transfer_pair(std::uint32_t h, std::uint32_t g, bool wide, Op& op) {
  op.d = u8(bits(g, 15, 12));
  op.n = u8(h & 15);
  op.m = u8(registers_of(h, g, wide).m);
  op.code = bit(h, 4) ? kVmovFromPair : kVmovToPair;
  if ((g & 0xD0) != 0x10 || bad(op.d) || bad(op.n) || (bit(h, 4) && op.d == op.n)) return false;
  return wide ? !bit(g, 5) : op.m != 31;
}

bool transfer_single(std::uint32_t h, std::uint32_t g, bool wide, Op& op) {
  op.d = u8(bits(g, 15, 12));
  if ((h & 0xFFEF) == 0xEEE1 && (g & 0xFFF) == 0xA10) {
    op.code = bit(h, 4) ? kVmrs : kVmsr;
    return op.d != 13 && (op.d != 15 || bit(h, 4));
  }
  if (bad(op.d)) return false;
  op.code = bit(h, 4) ? kVmovFromS : kVmovToS;
  if (wide) {
    op.m = u8((h & 15) * 2 + bits(h, 5, 5));
    return (h & 0xFFC0) == 0xEE00 && (g & 0xFF) == 0x10;
  }
  op.m = u8((h & 15) << 1 | bits(g, 7, 7));
  return (h & 0xFFE0) == 0xEE00 && (g & 0x7F) == 0x10;
}

}  // namespace

bool decode_coprocessor(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  if ((h & 0xEF00) == 0xEF00) return false;
  const std::uint32_t coprocessor = bits(g, 11, 8);
  if (at.variant.fpu == Fpu::kNone || coprocessor >> 1 != 5) {
    op.code = kNoCoprocessor;
    return true;
  }
  const bool wide = coprocessor == 11;
  if ((h & 0xFF00) == 0xFE00) return fpv5(at, h, g, wide, op);
  if (bit(h, 12)) return false;
  if ((h & 0xFF00) == 0xEE00)
    return bit(g, 4) ? transfer_single(h, g, wide, op) : arithmetic(at, h, g, wide, op);
  if ((h & 0xFFE0) == 0xEC40) return transfer_pair(h, g, wide, op);
  if ((h & 0xFFA0) == 0xEC00) return false;  // P, U, W all 0
  return list_access(at, h, g, wide, op);
}

}  // namespace omnihil::mcu
