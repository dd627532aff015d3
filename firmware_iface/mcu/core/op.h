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
inline constexpr std::uint8_t kAlways = 14;

// A row is what runs from an operation on without a jump. Its whole time is taken when it is entered, and
// what lies before the next operation is part of each: `charged`, which never changes once an operation is
// known, so that those before it stay right when it is decoded anew. Where it is then not `rest`, the
// operation is entered by kResync, which makes up for the difference.
struct Op {
  Code code = kUndecoded;
  std::uint16_t entry = kUndecoded;         // a Code: where the loop goes, for its condition or its code
  std::uint32_t imm = 0;                    // constant, branch target, register list
  std::uint8_t d = 0, n = 0, m = 0, a = 0;  // registers; `a` also a shift, a form, a condition
  std::uint8_t halfwords = 1;
  std::uint8_t condition : 4 = kAlways;  // of the IT block it stands in
  std::uint8_t last : 1 = 0;             // of a row: it may jump, or end the run
  std::uint8_t known : 1 = 0;
  std::uint8_t it = 0;                        // ITSTATE while it executes
  std::uint8_t count = 0, charged_count = 0;  // how many to the row's end: as this one stands, ...
  std::uint16_t cost = 0;                     // in 16ths of a cycle
  std::uint16_t rest = 0, charged = 0;        // ... as those before it took it; and in time
};
static_assert(sizeof(Op) == 24);

// What the operation costs before scaling, without the words of its list.
int op_cycles(Code code);
const char* op_name(Code code);

}  // namespace omnihil::mcu
