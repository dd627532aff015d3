// Random instructions for the differential test: the space is cut so that every group of encodings is met
// often.
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/core/decode.h"
#include "firmware_iface/mcu/core/fp.h"
#include "tests/firmware_iface/mcu/unicorn/oracle_protocol.h"

namespace omnihil::mcu {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  std::uint32_t word() { return static_cast<std::uint32_t>(oracle_mix(seed_ + counter_++)); }
  std::uint32_t below(std::uint32_t n) { return word() % n; }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::uint64_t seed_, counter_ = 0;
};

// Not drawn: IT alone (drawn with its block), SVC and BKPT (they end the run), CPS and MSR to special
// registers (the oracle keeps its own), WFE (it stops the oracle).
inline bool is_left_out(std::uint32_t h, std::uint32_t g) {
  const bool wide = h >> 11 >= 29;
  if (!wide) {
    return (h & 0xFF00) == 0xBF00 || (h & 0xFF00) == 0xDF00 || (h & 0xFF00) == 0xBE00 ||
           (h & 0xFFE0) == 0xB660;
  }
  if ((h & 0xFFF0) == 0xF380 && (g & 0xD000) == 0x8000) return (g & 0xFF) > 3;
  return h == 0xF3AF || (h == 0xF3EF && (g & 0xFF) > 3);
}

// A wide encoding of one group; about half of them exist.
inline void draw_wide(Draw& draw, bool doubles, std::uint32_t& h, std::uint32_t& g) {
  h = draw.word() & 0xFFFF;
  g = draw.word() & 0xFFFF;
  const std::uint32_t precision = doubles && draw.one_in(2) ? 0xB00 : 0xA00;
  switch (draw.below(12)) {
    case 0:
      h = 0xE800 | (h & 0x1FF);
      break;  // lists, pairs, exclusives, tables
    case 1:
      h = 0xEA00 | (h & 0x1FF), g &= 0x7FFF;
      break;  // shifted register
    case 2:
      h = 0xF000 | (h & 0x5FF), g &= 0x7FFF;
      break;  // modified immediate
    case 3:
      h = 0xF200 | (h & 0x5FF), g &= 0x7FFF;
      break;  // plain immediate
    case 4:
      h = 0xF000 | (h & 0x7FF), g |= 0x8000;
      break;  // branches
    case 5:
      h = 0xF800 | (h & 0x1FF);
      break;  // loads and stores
    case 6:
      h = 0xFA00 | (h & 0xFF), g |= 0xF000;
      break;  // registers
    case 7:
      h = 0xFB00 | (h & 0x7F), g &= 0xFF3F;
      break;  // multiplication
    case 8:
      h = 0xFB80 | (h & 0x7F);
      if (draw.one_in(3)) g |= 0xF0F0;  // division
      break;
    case 9:  // FP arithmetic and conversions
      h = 0xEE00 | (h & 0xFF);
      g = (g & 0xF0EF) | precision;
      if (draw.one_in(3)) h = 0xEEB0 | (h & 0x4F), g |= 0x40;
      break;
    case 10:
      h = 0xEC00 | (h & 0x1FF), g = (g & 0xF0FF) | precision;
      break;  // FP loads, stores, pairs
    default:
      if (doubles && draw.one_in(2)) {
        h = 0xFE00 | (h & 0xFF), g = (g & 0xF0EF) | precision;
        if (draw.one_in(3)) h = 0xFEB8 | (h & 0x47), g |= 0x40;
      } else {
        h = 0xEE00 | (h & 0xFF), g = (g & 0xF0FF) | 0x010 | precision;  // FP transfers
      }
  }
}

// Most of what is refused here is drawn anew: an eighth of it is enough to see what the oracle says.
inline void draw_instruction(Draw& draw, const Variant& variant, std::uint16_t* code) {
  const bool narrow_only = variant.arch == Arch::kV6M, doubles = variant.fpu == Fpu::kDouble;
  bool refused = true;
  do {
    std::uint32_t h = 0, g = 0xBF00;
    if (narrow_only || draw.one_in(3)) {
      do h = draw.word() & 0xFFFF;
      while (h >> 11 >= 29);
    } else {
      draw_wide(draw, doubles, h, g);
    }
    if (is_left_out(h, g)) continue;
    code[0] = static_cast<std::uint16_t>(h);
    code[1] = static_cast<std::uint16_t>(g);
    refused = decode({kOracleCode, variant, 0}, code[0], code[1]).code == kUndefined && !draw.one_in(8);
  } while (refused);
}

inline std::uint32_t draw_value(Draw& draw) {
  switch (draw.below(6)) {
    case 0:
      return draw.word();
    case 1:
      return draw.below(64);
    case 2:
      return draw.one_in(2) ? 0x80000000u : 0xFFFFFFFFu >> draw.below(32);
    default:
      return kOracleRam + 0x1000 + 4 * draw.below(0x7F0);
  }
}

inline std::uint32_t draw_float(Draw& draw) {
  constexpr std::uint32_t kSpecial[] = {0x7F800000, 0xFF800000, 0x7FC00000, 0xFFC12345,
                                        0x7F812345, 0xFF800001, 1,          0x807FFFFF,
                                        0x00800000, 0x7F7FFFFF, 0x80000000, 0};
  switch (draw.below(6)) {
    case 0:
      return kSpecial[draw.below(12)];
    case 1:
      return draw.word();
    case 2:
      return (draw.word() & 0x80000000u) | (0x3F000000 + (draw.word() & 0x01FFFFFF));
    case 3:
      return (draw.word() & 0xFFFF0000u);
    default:
      return (draw.word() & 0x80000000u) | (0x30000000 + (draw.word() & 0x1FFFFFFF));
  }
}

// The oracle rounds it by FPSCR, the manual to nearest: compared in that mode alone.
inline bool is_from_fixed(Code code) { return code == kVcvtFromFixedF32 || code == kVcvtFromFixedF64; }

inline void draw_state(Draw& draw, bool doubles, OracleCase& c) {
  for (std::uint32_t& r : c.r) r = draw_value(draw);
  c.r[13] = kOracleRam + 0x1800 + 8 * draw.below(0x80);
  c.apsr = draw.word() & 0xF80F0000u;
  if (c.apsr >> 30 == 3) c.apsr &= ~0x40000000u;
  for (std::uint32_t& s : c.s) s = draw_float(draw);
  if (doubles) {
    constexpr std::uint32_t kSpecial[] = {0x7FF00000, 0xFFF00000, 0x7FF80000, 0x7FF00001,
                                          0,          0x80000000, 0x000FFFFF};
    for (int i = 1; i < 32; i += 2) {
      if (draw.one_in(2)) c.s[i] = (draw.word() & 0x80000000u) | (0x3E000000 + (draw.word() & 0x03FFFFFF));
      if (draw.one_in(6)) c.s[i] = kSpecial[draw.below(7)];
      if (draw.one_in(4)) c.s[i - 1] = 0;
    }
  }
  c.fpscr = draw.one_in(4) ? draw.below(8) << 22 & 0x02C00000u : 0;
  if (draw.one_in(8)) c.fpscr |= 1u << 25;
  const Code code = decode({kOracleCode, kCortexM7, 0}, c.code[0], c.code[1]).code;
  if (c.until == 0 && is_from_fixed(code)) c.fpscr &= ~0x00C00000u;
  // Flushing differs where a result rounds up to the smallest normal number, see fp_flush(): kept out of
  // rows.
  if (c.until == 0 && draw.one_in(8)) c.fpscr |= kFlushToZero;
}

// Neither jumps nor touches memory or what belongs to the system, nor SP (whose low bits the oracle keeps),
// nor shows FPSCR's cumulative flags (which are not modelled).
inline bool is_straight(const Op& op) {
  const Code code = op.code;
  if (code == kMovToPc || code == kAddHigh || op.d == 13 || is_from_fixed(code)) return false;
  return (code >= kAndImm && code <= kParallel) ||
         (code >= kVaddF32 && (code < kVmrs || (code == kVmrs && op.d == 15)));
}

// Several instructions in a row; `count` says how many. Returns their bytes.
inline std::uint32_t draw_row(Draw& draw, const Variant& variant, std::uint16_t* code, std::uint32_t& count) {
  std::uint32_t at = 0;
  for (count = 0; at < kOracleSlotBytes / 2 - 3; ++count) {
    Op op;
    do {
      draw_instruction(draw, variant, code + at);
      op = decode({kOracleCode + 2 * at, variant, 0}, code[at], code[at + 1]);
    } while (!is_straight(op));
    at += op.halfwords;
  }
  code[at] = 0xE7FE;
  return at * 2;
}

// What follows an IT instruction in its block: 16- and 32-bit forms that neither branch nor touch memory.
inline std::uint32_t draw_block(Draw& draw, std::uint16_t* code) {
  const std::uint32_t condition = draw.below(14), mask = 1 + draw.below(15);
  code[0] = static_cast<std::uint16_t>(0xBF00 | condition << 4 | mask);
  const std::uint32_t length = mask & 1 ? 4 : mask & 2 ? 3 : mask & 4 ? 2 : 1;
  std::uint32_t at = 1;
  for (std::uint32_t i = 0; i < length; ++i) {
    std::uint32_t h = draw.word() & 0x3FFF;
    if (draw.one_in(3)) h = 0x4000 | (h & 0x3FF);
    if (draw.one_in(4)) {
      code[at++] = static_cast<std::uint16_t>(0xEA40 | (h & 0x1F7));
      code[at++] = static_cast<std::uint16_t>(draw.word() & 0x77F7);
    } else {
      code[at++] = static_cast<std::uint16_t>(h);
    }
  }
  code[at] = 0xE7FE;
  return at * 2;
}

}  // namespace omnihil::mcu
