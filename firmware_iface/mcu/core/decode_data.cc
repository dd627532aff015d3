// 32-bit data processing: shifted register, modified and plain immediate (DDI 0403E.e A5.3.1, A5.3.3,
// A5.3.11).
#include <bit>

#include "firmware_iface/mcu/core/decode.h"

namespace omnihil::mcu {
namespace {

// ThumbExpandImm_C (A5.3.2). `carry`: 0 or 1, or 2 for "unchanged".
bool expand_immediate(std::uint32_t imm12, std::uint32_t& value, std::uint8_t& carry) {
  const std::uint32_t byte = imm12 & 255;
  carry = 2;
  if (imm12 >> 10 == 0) {
    constexpr std::uint32_t kPattern[] = {1, 0x00010001, 0x01000100, 0x01010101};
    value = byte * kPattern[imm12 >> 8];
    return imm12 >> 8 == 0 || byte != 0;
  }
  value = std::rotr(0x80 | (byte & 0x7F), static_cast<int>(imm12 >> 7));
  carry = u8(value >> 31);
  return true;
}

// The operation `which` of both the shifted and the immediate table, on registers already in `op`.
bool data_operation(std::uint32_t which, bool flags, OperandForm form, bool sp_shift_allowed, Op& op) {
  const bool bad_m = form != kFormImm && bad(op.m), none = op.d == 15 && flags;
  const auto plain = [&](Code family) {
    op.code = alu(family, form, flags);
    return !bad(op.d) && !bad(op.n) && !bad_m;
  };
  const auto compare = [&](Code family, bool sp_allowed) {
    op.code = test(family, form);
    return op.n != 15 && (op.n != 13 || sp_allowed) && !bad_m;
  };
  const auto add = [&](Code family) {
    op.code = alu(family, form, flags);
    if (op.d == 13 && family == kSubImm && form == kFormImm && !flags) op.code = kSubSp;
    if (op.n == 13 && op.d == 13) return sp_shift_allowed && !bad_m;
    return !bad(op.d) && op.n != 15 && !bad_m;
  };
  switch (which) {
    case 0:
      return none ? compare(kTstImm, false) : plain(kAndImm);
    case 1:
      return plain(kBicImm);
    case 2:
      if (op.n != 15) return plain(kOrrImm);
      op.n = 0;
      if (form == kFormReg && !flags) {  // MOV.W takes SP on one side
        op.code = op.d == 13 ? kMovSp : kMovReg;
        return op.d != 15 && op.m != 15 && !(op.d == 13 && op.m == 13);
      }
      return plain(kMovImm);
    case 3:
      if (op.n != 15) return plain(kOrnImm);
      op.n = 0;
      return plain(kMvnImm);
    case 4:
      return none ? compare(kTeqImm, false) : plain(kEorImm);
    case 8:
      return none ? compare(kCmnImm, true) : add(kAddImm);
    case 10:
      return plain(kAdcImm);
    case 11:
      return plain(kSbcImm);
    case 13:
      return none ? compare(kCmpImm, true) : add(kSubImm);
    case 14:
      return plain(kRsbImm);
    default:
      return false;
  }
}

bool saturate(const DecodeContext& at, std::uint32_t h, std::uint32_t g, bool is_signed, Op& op) {
  const std::uint32_t shift = bits(g, 14, 12) << 2 | bits(g, 7, 6);
  if (bit(h, 10) || bit(g, 5) || bad(op.d) || bad(op.n)) return false;
  if (bit(h, 5) && shift == 0) {
    op.imm = (g & 15) + (is_signed ? 1 : 0);
    op.code = is_signed ? kSsat16 : kUsat16;
    return at.dsp() && !bit(g, 4);
  }
  op.imm = (g & 31) + (is_signed ? 1 : 0);
  op.a = u8(shift);
  op.m = bit(h, 5) ? 2 : 0;  // ASR or LSL
  op.code = is_signed ? kSsat : kUsat;
  return true;
}

bool plain_immediate(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const std::uint32_t imm12 = (bit(h, 10) ? 0x800u : 0) | bits(g, 14, 12) << 8 | (g & 255);
  const std::uint32_t lsb = bits(g, 14, 12) << 2 | bits(g, 7, 6), width = g & 31;
  op.d = u8(bits(g, 11, 8));
  op.n = u8(h & 15);
  switch (bits(h, 8, 4)) {
    case 0:
    case 10: {
      const bool add = bits(h, 8, 4) == 0;
      op.imm = imm12;
      op.a = 2;
      if (op.n == 15) {  // ADR
        op.imm = add ? at.literal_base() + imm12 : at.literal_base() - imm12;
        op.code = kMovImm;
        return !bad(op.d);
      }
      op.code = add ? kAddImm : op.d == 13 ? kSubSp : kSubImm;
      return op.d != 15 && (op.d != 13 || op.n == 13);
    }
    case 4:
    case 12:
      op.imm = (h & 15) << 12 | imm12;
      op.a = 2;
      op.code = bits(h, 8, 4) == 4 ? kMovImm : kMovt;
      return !bad(op.d);
    case 16:
    case 18:
      return saturate(at, h, g, true, op);
    case 24:
    case 26:
      return saturate(at, h, g, false, op);
    case 20:
    case 28:
      op.a = u8(lsb);
      op.imm = width + 1;
      op.code = bits(h, 8, 4) == 20 ? kSbfx : kUbfx;
      return !bit(h, 10) && !bit(g, 5) && !bad(op.d) && !bad(op.n) && lsb + width <= 31;
    case 22:
      op.a = u8(lsb);
      op.imm = width - lsb + 1;
      op.code = op.n == 15 ? kBfc : kBfi;
      return !bit(h, 10) && !bit(g, 5) && !bad(op.d) && op.n != 13 && width >= lsb;
    default:
      return false;
  }
}

}  // namespace

bool decode_data_shifted(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const std::uint32_t which = bits(h, 8, 5), type = bits(g, 5, 4);
  std::uint32_t amount = bits(g, 14, 12) << 2 | bits(g, 7, 6);
  const bool flags = bit(h, 4);
  op.n = u8(h & 15);
  op.d = u8(bits(g, 11, 8));
  op.m = u8(g & 15);
  if (bit(g, 15)) return false;
  if (which == 6) {  // PKHBT, PKHTB
    op.imm = bit(g, 5) && amount == 0 ? 32 : amount;
    op.code = bit(g, 5) ? kPkhtb : kPkhbt;
    return at.dsp() && !flags && !bit(g, 4) && !bad(op.d) && !bad(op.n) && !bad(op.m);
  }
  op.a = u8(type);
  const bool sp_shift_allowed = type == 0 && amount <= 3;
  if (type == 3 && amount == 0) {
    op.a = 4;  // RRX
  } else if (type != 0 && amount == 0) {
    amount = 32;
  }
  op.imm = amount;
  const OperandForm form = type == 0 && amount == 0 ? kFormReg : kFormShift;
  return data_operation(which, flags, form, sp_shift_allowed, op);
}

bool decode_data_immediate(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  if (bit(h, 9)) return plain_immediate(at, h, g, op);
  op.n = u8(h & 15);
  op.d = u8(bits(g, 11, 8));
  const std::uint32_t imm12 = (bit(h, 10) ? 0x800u : 0) | bits(g, 14, 12) << 8 | (g & 255);
  const bool fits = expand_immediate(imm12, op.imm, op.a);
  return fits && data_operation(bits(h, 8, 5), bit(h, 4), kFormImm, true, op);
}

}  // namespace omnihil::mcu
