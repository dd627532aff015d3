// One pre-decoded instruction. Every halfword of memory that code runs from has a slot of this kind, filled
// when it is first executed and emptied when the halfword is written to.
#pragma once
#include <cstdint>

namespace omnihil::mcu {

enum Code : std::uint16_t {
#define OP(name, cycles) k##name,
#include "firmware_iface/mcu/core/op_codes.inc"
#undef OP
  kCodes
};

inline constexpr int kSubcycles = 16;  // time is counted in 16ths of a cycle, so that costs can be scaled
inline constexpr int kTakenBranchCycles = 2;
inline constexpr std::uint8_t kAlways = 14;

struct Op {
  Code code = kUndecoded;
  std::uint16_t cost = 0;                   // in 16ths of a cycle
  std::uint32_t imm = 0;                    // constant, branch target, register list
  std::uint8_t d = 0, n = 0, m = 0, a = 0;  // registers; `a` also a shift, a form, a condition
  std::uint8_t condition : 4 = kAlways;     // of the IT block it stands in
  std::uint8_t halfwords : 4 = 1;           // in the upper half: masked, the bytes to the next slot
  std::uint8_t it = 0;                      // ITSTATE while it executes
  std::uint16_t entry = kUndecoded;         // a Code: where the loop goes, for its condition or its code
};
static_assert(sizeof(Op) == 16);

// What the operation costs before scaling, without the words of its list.
int op_cycles(Code code);
const char* op_name(Code code);

}  // namespace omnihil::mcu
