// 32-bit data processing on registers, multiplication and division (DDI 0403E.e A5.3.12 to A5.3.17).
#include "firmware_iface/mcu/core/decode.h"

namespace omnihil::mcu {
namespace {

bool extend(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  constexpr Code kAccumulate[] = {kSxtah, kUxtah, kSxtab16, kUxtab16, kSxtab, kUxtab};
  constexpr Code kPlain[] = {kSxth, kUxth, kSxtb16, kUxtb16, kSxtb, kUxtb};
  const std::uint32_t which = bits(h, 6, 4);
  if (which > 5 || bit(g, 6) || bad(op.d) || bad(op.m) || op.n == 13) return false;
  op.a = u8(bits(g, 5, 4) * 8);
  op.code = op.n == 15 ? kPlain[which] : kAccumulate[which];
  return at.dsp() || (op.n == 15 && which != 2 && which != 3);
}

bool unary_and_saturating(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  constexpr Code kOps[4][4] = {{kQadd, kQdadd, kQsub, kQdsub},
                               {kRev, kRev16, kRbit, kRevsh},
                               {kSel, kUndefined, kUndefined, kUndefined},
                               {kClz, kUndefined, kUndefined, kUndefined}};
  const std::uint32_t row = bits(h, 5, 4);
  op.code = kOps[row][bits(g, 5, 4)];
  if (op.code == kUndefined || bad(op.d) || bad(op.n) || bad(op.m)) return false;
  return row == 1 || row == 3 ? op.n == op.m : at.dsp();
}

}  // namespace

bool decode_data_register(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  op.d = u8(bits(g, 11, 8));
  op.n = u8(h & 15);
  op.m = u8(g & 15);
  if (bits(g, 15, 12) != 15) return false;
  if (!bit(h, 7)) {
    if (bit(g, 7)) return extend(at, h, g, op);
    constexpr Code kOps[] = {kLsl, kLsr, kAsr, kRor};
    op.code = offset(kOps[bits(h, 6, 5)], bit(h, 4) ? 1 : 0);
    return bits(g, 6, 4) == 0 && !bad(op.d) && !bad(op.n) && !bad(op.m);
  }
  if (bit(g, 7)) return !bit(h, 6) && !bit(g, 6) && unary_and_saturating(at, h, g, op);
  op.code = kParallel;
  op.a = u8(bits(h, 6, 4));
  op.imm = bits(g, 6, 4);
  const bool exists = op.a != 3 && op.a != 7 && (op.imm & 3) != 3;
  return at.dsp() && exists && !bad(op.d) && !bad(op.n) && !bad(op.m);
}

namespace {

bool multiply_long(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  const std::uint32_t row = bits(h, 6, 4), which = bits(g, 7, 4);
  op.d = u8(bits(g, 15, 12));  // low word
  op.a = u8(bits(g, 11, 8));   // high word
  if (row == 1 || row == 3) {
    if (op.d != 15 || which != 15) return false;
    op.d = op.a;
    op.code = row == 1 ? kSdiv : kUdiv;
    return !bad(op.d) && !bad(op.n) && !bad(op.m);
  }
  bool dsp = true;
  op.imm = which & 3;
  if (row == 0 && which == 0) {
    op.code = kSmull;
    dsp = false;
  } else if (row == 2 && which == 0) {
    op.code = kUmull;
    dsp = false;
  } else if (row == 4 && which == 0) {
    op.code = kSmlal;
    dsp = false;
  } else if (row == 6 && which == 0) {
    op.code = kUmlal;
    dsp = false;
  } else if (row == 4 && which >> 2 == 2) {
    op.code = kSmlalxy;
  } else if ((row == 4 || row == 5) && which >> 1 == 6) {
    op.code = row == 4 ? kSmlald : kSmlsld;
  } else if (row == 6 && which == 6) {
    op.code = kUmaal;
  } else {
    return false;
  }
  return (at.dsp() || !dsp) && !bad(op.d) && !bad(op.a) && !bad(op.n) && !bad(op.m) && op.d != op.a;
}

}  // namespace

bool decode_multiply(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  op.n = u8(h & 15);
  op.m = u8(g & 15);
  if (bit(h, 7)) return multiply_long(at, h, g, op);
  op.d = u8(bits(g, 11, 8));
  op.a = u8(bits(g, 15, 12));
  op.imm = bits(g, 5, 4);
  if (bits(g, 7, 6) != 0 || bad(op.d) || bad(op.n) || bad(op.m) || op.a == 13) return false;
  const bool none = op.a == 15, one_bit = op.imm < 2;
  switch (bits(h, 6, 4)) {
    case 0:
      if (op.imm == 0) op.code = none ? kMul : kMla;
      if (op.imm == 1) op.code = kMls;
      return one_bit && !(op.imm == 1 && none);
    case 1:
      op.code = none ? kSmulxy : kSmlaxy;
      return at.dsp();
    case 2:
      op.code = none ? kSmuad : kSmlad;
      return at.dsp() && one_bit;
    case 3:
      op.code = none ? kSmulwy : kSmlawy;
      return at.dsp() && one_bit;
    case 4:
      op.code = none ? kSmusd : kSmlsd;
      return at.dsp() && one_bit;
    case 5:
      op.code = none ? kSmmul : kSmmla;
      return at.dsp() && one_bit;
    case 6:
      op.code = kSmmls;
      return at.dsp() && one_bit && !none;
    default:
      op.code = kUsada8;
      return at.dsp() && op.imm == 0;
  }
}

}  // namespace omnihil::mcu
