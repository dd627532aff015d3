// 16-bit encodings, DDI 0403E.e A5.2.
#include <bit>

#include "firmware_iface/mcu/core/decode.h"

namespace omnihil::mcu {
namespace {

bool add_shift_immediate(const DecodeContext& at, std::uint32_t h, Op& op) {  // 00xxxx
  const bool flags = !at.in_it();
  if (bit(h, 13)) {  // MOV, CMP, ADD, SUB of 8 bits
    op.d = op.n = u8(bits(h, 10, 8));
    op.imm = h & 255;
    op.a = 2;
    constexpr Code kFamily[] = {kMovImm, kCmpImm, kAddImm, kSubImm};
    const std::uint32_t which = bits(h, 12, 11);
    op.code = which == 1 ? kCmpImm : alu(kFamily[which], kFormImm, flags);
    return true;
  }
  op.d = u8(h & 7);
  const std::uint32_t type = bits(h, 12, 11);
  if (type == 3) {
    op.n = u8(bits(h, 5, 3));
    op.m = u8(bits(h, 8, 6));
    op.imm = op.m;
    op.code = alu(bit(h, 9) ? kSubImm : kAddImm, bit(h, 10) ? kFormImm : kFormReg, flags);
    return true;
  }
  op.m = u8(bits(h, 5, 3));
  op.a = u8(type);
  op.imm = bits(h, 10, 6);
  if (type == 0 && op.imm == 0) {  // MOVS Rd, Rm
    op.code = kMovRegS;
    return flags;
  }
  if (op.imm == 0) op.imm = 32;
  op.code = alu(kMovImm, kFormShift, flags);
  return true;
}

bool data_processing(const DecodeContext& at, std::uint32_t h, Op& op) {  // 010000
  const bool flags = !at.in_it();
  op.d = op.n = u8(h & 7);
  op.m = u8(bits(h, 5, 3));
  const auto family = [&](Code code) { op.code = alu(code, kFormReg, flags); };
  const auto pair = [&](Code code) { op.code = offset(code, flags ? 1 : 0); };
  switch (bits(h, 9, 6)) {
    case 0:
      family(kAndImm);
      break;
    case 1:
      family(kEorImm);
      break;
    case 2:
      pair(kLsl);
      break;
    case 3:
      pair(kLsr);
      break;
    case 4:
      pair(kAsr);
      break;
    case 5:
      family(kAdcImm);
      break;
    case 6:
      family(kSbcImm);
      break;
    case 7:
      pair(kRor);
      break;
    case 8:
      op.code = kTstReg;
      break;
    case 9:  // RSB Rd, Rn, #0
      op.n = op.m;
      op.code = alu(kRsbImm, kFormImm, flags);
      break;
    case 10:
      op.code = kCmpReg;
      break;
    case 11:
      op.code = kCmnReg;
      break;
    case 12:
      family(kOrrImm);
      break;
    case 13:
      pair(kMul);
      break;
    case 14:
      family(kBicImm);
      break;
    default:
      family(kMvnImm);
      break;
  }
  return true;
}

bool high_registers(const DecodeContext& at, std::uint32_t h, Op& op) {  // 010001
  op.d = op.n = u8((h & 7) | (h >> 4 & 8));
  op.m = u8(bits(h, 6, 3));
  switch (bits(h, 9, 8)) {
    case 0:
      op.code = op.d == 13 || op.d == 15 || op.m == 15 ? kAddHigh : kAddReg;
      return !(op.d == 15 && (op.m == 15 || at.mid_it()));
    case 1:
      op.code = kCmpReg;
      return op.n != 15 && op.m != 15 && (op.n >= 8 || op.m >= 8);
    case 2:
      op.code = op.d == 15 ? kMovToPc : op.m == 15 ? kMovFromPc : op.d == 13 ? kMovSp : kMovReg;
      return !(op.d == 15 && at.mid_it());
    default:
      op.code = bit(h, 7) ? kBlx : kBx;
      return (h & 7) == 0 && !at.mid_it() && op.m != 15;
  }
}

bool access(std::uint32_t h, Op& op) {  // 0101, 011x, 100x
  op.d = u8(h & 7);
  op.n = u8(bits(h, 5, 3));
  const bool load = bit(h, 11);
  switch (h >> 12) {
    case 5: {
      constexpr Code kOps[] = {kStrReg, kStrhReg, kStrbReg, kLdrsbReg,
                               kLdrReg, kLdrhReg, kLdrbReg, kLdrshReg};
      op.m = u8(bits(h, 8, 6));
      op.code = kOps[bits(h, 11, 9)];
      return true;
    }
    case 6:
      op.imm = bits(h, 10, 6) * 4;
      op.code = load ? kLdrImm : kStrImm;
      return true;
    case 7:
      op.imm = bits(h, 10, 6);
      op.code = load ? kLdrbImm : kStrbImm;
      return true;
    case 8:
      op.imm = bits(h, 10, 6) * 2;
      op.code = load ? kLdrhImm : kStrhImm;
      return true;
    default:  // SP-relative
      op.d = u8(bits(h, 10, 8));
      op.n = 13;
      op.imm = (h & 255) * 4;
      op.code = load ? kLdrImm : kStrImm;
      return true;
  }
}

bool hints(const DecodeContext& at, std::uint32_t h, Op& op) {  // 10111111
  if (is_it(static_cast<std::uint16_t>(h))) {
    const std::uint32_t condition = bits(h, 7, 4), mask = h & 15;
    op.code = kNop;
    return at.v7() && !at.in_it() && condition != 15 && !(condition == 14 && std::popcount(mask) != 1);
  }
  constexpr Code kHints[] = {kNop, kNop, kWfe, kWfi, kSev};
  op.code = bits(h, 7, 4) < 5 ? kHints[bits(h, 7, 4)] : kNop;
  return true;
}

bool push_pop(const DecodeContext& at, std::uint32_t h, Op& op) {
  const bool pop = bit(h, 11);
  op.n = 13;
  op.imm = (h & 255) | (bit(h, 8) ? (pop ? 0x8000u : 0x4000u) : 0);
  op.a = pop ? 1 : 3;
  op.code = pop ? (op.imm & 0x8000 ? kPopPc : kLdm) : kPush;
  return op.imm != 0 && !((op.imm & 0x8000) && at.mid_it());
}

bool miscellaneous(const DecodeContext& at, std::uint32_t h, Op& op) {  // 1011
  switch (bits(h, 11, 8)) {
    case 0:
      op.d = op.n = 13;
      op.imm = (h & 127) * 4;
      op.code = bit(h, 7) ? kSubSp : kAddImm;
      return true;
    case 1:
    case 3:
    case 9:
    case 11:
      op.n = u8(h & 7);
      op.imm = at.pc + 4 + (bits(h, 7, 3) << 1 | (bit(h, 9) ? 64u : 0));
      op.code = bit(h, 11) ? kCbnz : kCbz;
      return at.v7() && !at.in_it();
    case 2: {
      constexpr Code kOps[] = {kSxth, kSxtb, kUxth, kUxtb};
      op.d = u8(h & 7);
      op.m = u8(bits(h, 5, 3));
      op.code = kOps[bits(h, 7, 6)];
      return true;
    }
    case 4:
    case 5:
    case 12:
    case 13:
      return push_pop(at, h, op);
    case 6:  // CPSIE, CPSID
      op.imm = h & 0x13;
      op.code = kCps;
      return (h & 0xFFEC) == 0xB660 && (h & 3) != 0 && !at.in_it() && (at.v7() || (h & 3) == 2);
    case 10: {
      constexpr Code kOps[] = {kRev, kRev16, kUndefined, kRevsh};
      op.d = u8(h & 7);
      op.m = u8(bits(h, 5, 3));
      op.code = kOps[bits(h, 7, 6)];
      return op.code != kUndefined;
    }
    case 14:
      op.imm = h & 255;
      op.code = kBkpt;
      op.condition = kAlways;  // whatever the IT block says
      return true;
    case 15:
      return hints(at, h, op);
    default:
      return false;
  }
}

bool branches(const DecodeContext& at, std::uint32_t h, Op& op) {  // 1101, 11100
  if (h >> 12 == 14) {
    op.imm = at.pc + 4 + static_cast<std::uint32_t>(static_cast<std::int32_t>(h << 21) >> 20);
    op.code = kB;
    return !at.mid_it();
  }
  const std::uint32_t condition = bits(h, 11, 8);
  if (condition == 15) {
    op.imm = h & 255;
    op.code = kSvc;
    return true;
  }
  op.imm = at.pc + 4 + static_cast<std::uint32_t>(static_cast<std::int32_t>(h << 24) >> 23);
  op.a = u8(condition);
  op.code = kBcond;
  return condition != 14 && !at.in_it();
}

}  // namespace

bool decode_narrow(const DecodeContext& at, std::uint32_t h, Op& op) {
  switch (h >> 12) {
    case 0:
    case 1:
    case 2:
    case 3:
      return add_shift_immediate(at, h, op);
    case 4:
      if (!bit(h, 11)) return bit(h, 10) ? high_registers(at, h, op) : data_processing(at, h, op);
      op.d = u8(bits(h, 10, 8));
      op.imm = at.literal_base() + (h & 255) * 4;
      op.code = kLdrLit;
      return true;
    case 10:
      op.d = u8(bits(h, 10, 8));
      op.n = 13;
      op.a = 2;
      op.imm = (h & 255) * 4 + (bit(h, 11) ? 0 : at.literal_base());
      op.code = bit(h, 11) ? kAddImm : kMovImm;
      return true;
    case 11:
      return miscellaneous(at, h, op);
    case 12:
      op.n = u8(bits(h, 10, 8));
      op.imm = h & 255;
      op.a = !bit(h, 11) || !bit(h, op.n) ? 1 : 0;
      op.code = bit(h, 11) ? kLdm : kStm;
      return op.imm != 0;
    case 13:
    case 14:
      return branches(at, h, op);
    default:
      return access(h, op);
  }
}

}  // namespace omnihil::mcu
