// 32-bit loads and stores (DDI 0403E.e A5.3.5 to A5.3.10).
#include <bit>

#include "firmware_iface/mcu/core/decode.h"

namespace omnihil::mcu {
namespace {

enum Size { kByte = 0, kHalf = 1, kWord = 2 };

// The operation of an ACCESS_OPS family: loads first, then stores.
std::uint32_t access_of(std::uint32_t size, bool load, bool is_signed) {
  constexpr std::uint32_t kLoad[] = {1, 2, 0}, kSigned[] = {3, 4, 0}, kStore[] = {6, 7, 5};
  return load ? (is_signed ? kSigned[size] : kLoad[size]) : kStore[size];
}

// A load whose destination is the PC: a jump for a word, a preload hint otherwise.
bool load_to_pc(const DecodeContext& at, std::uint32_t size, Op& op) {
  if (size == kWord) {
    const std::uint8_t shift = op.a;  // of the register form
    op.a = u8(op.code >= kLdrLit    ? 4
              : op.code >= kLdrPost ? 3
              : op.code >= kLdrPre  ? 2
              : op.code >= kLdrReg  ? 1
                                    : 0);
    op.d = op.a == 1 ? shift : u8(0);
    op.code = kLdrPc;
    return !at.mid_it();
  }
  const bool writes_back = op.code >= kLdrPre && op.code < kLdrLit;
  op.code = kNop;
  return !writes_back;
}

}  // namespace

bool decode_single_access(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const std::uint32_t size = bits(h, 6, 5);
  const bool load = bit(h, 4), is_signed = bit(h, 8);
  if (size == 3 || (is_signed && (!load || size == kWord))) return false;
  const std::uint32_t which = access_of(size, load, is_signed);
  op.n = u8(h & 15);
  op.d = u8(bits(g, 15, 12));
  if (!load && (op.n == 15 || op.d == 15)) return false;
  if (op.d == 13 && size != kWord) return false;
  if (load && op.n == 15) {
    op.imm = bit(h, 7) ? at.literal_base() + (g & 0xFFF) : at.literal_base() - (g & 0xFFF);
    op.code = offset(kLdrLit, which);
  } else if (bit(h, 7)) {
    op.imm = g & 0xFFF;
    op.code = offset(kLdrImm, which);
  } else if (!bit(g, 11)) {
    op.m = u8(g & 15);
    op.a = u8(bits(g, 5, 4));
    op.code = offset(kLdrReg, which);
    if (bits(g, 10, 6) != 0 || bad(op.m)) return false;
  } else {
    const bool before = bit(g, 10), up = bit(g, 9), back = bit(g, 8);
    op.imm = up ? g & 255 : 0u - (g & 255);
    op.code = offset(back ? (before ? kLdrPre : kLdrPost) : kLdrImm, which);
    if (!before && !back) return false;
    if (back && op.n == op.d) return false;
    const bool unprivileged = before && up && !back;
    if (unprivileged && bad(op.d)) return false;
  }
  return load && op.d == 15 ? load_to_pc(at, size, op) : true;
}

namespace {

bool exclusive_or_table(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const bool load = bit(h, 4);
  const std::uint32_t t = bits(g, 15, 12), d = bits(g, 11, 8), kind = bits(g, 7, 4);
  op.n = u8(h & 15);
  if (!bit(h, 7)) {  // LDREX, STREX
    op.imm = (g & 255) * 4;
    op.d = u8(load ? t : d);
    op.m = u8(t);
    op.code = load ? kLdrex : kStrex;
    if (op.n == 15 || bad(t)) return false;
    return load ? d == 15 : !bad(d) && d != op.n && d != t;
  }
  if (load && kind < 2) {  // TBB, TBH
    op.m = u8(g & 15);
    op.imm = at.pc + 4;
    op.code = kind == 0 ? kTbb : kTbh;
    return (g & 0xFFE0) == 0xF000 && op.n != 13 && !bad(op.m) && !at.mid_it();
  }
  if ((kind != 4 && kind != 5) || d != 15 || op.n == 15 || bad(t)) return false;
  op.m = u8(t);
  op.d = u8(load ? t : g & 15);
  op.code = load ? (kind == 4 ? kLdrexb : kLdrexh) : (kind == 4 ? kStrexb : kStrexh);
  return load ? (g & 15) == 15 : !bad(op.d) && op.d != op.n && op.d != t;
}

bool dual(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const bool load = bit(h, 4), back = bit(h, 5), before = bit(h, 8), up = bit(h, 7);
  op.n = u8(h & 15);
  op.d = u8(bits(g, 15, 12));
  op.m = u8(bits(g, 11, 8));
  op.imm = (g & 255) * 4;
  if (!up) op.imm = 0u - op.imm;
  op.a = u8((before ? 1 : 0) | (back ? 2 : 0));
  op.code = load ? kLdrd : kStrd;
  if (bad(op.d) || bad(op.m) || (load && op.d == op.m)) return false;
  if (back && (op.n == op.d || op.n == op.m)) return false;
  if (op.n != 15) return true;
  op.imm += at.literal_base();  // absolute
  op.a = 4;
  return load && !back;
}

}  // namespace

bool decode_multiple_access(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const bool back = bit(h, 5), load = bit(h, 4);
  if (bit(h, 6)) return bit(h, 8) || back ? dual(at, h, g, op) : exclusive_or_table(at, h, g, op);
  const std::uint32_t mode = bits(h, 8, 7);  // 1: increment after, 2: decrement before
  op.n = u8(h & 15);
  op.imm = g;
  op.a = u8((back ? 1 : 0) | (mode == 2 ? 2 : 0));
  if ((mode != 1 && mode != 2) || op.n == 15 || (g & 0x2000) || std::popcount(g) < 2) return false;
  if (back && bit(g, op.n)) return false;
  if (!load) {
    op.code = op.n == 13 && op.a == 3 ? kPush : kStm;
    return !(g & 0x8000);
  }
  op.code = op.n == 13 && op.a == 1 && (g & 0x8000) ? kPopPc : kLdm;
  return (g & 0xC000) != 0xC000 && !((g & 0x8000) && at.mid_it());
}

}  // namespace omnihil::mcu
