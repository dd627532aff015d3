// Thumb and Thumb-2 to micro-operations, strictly: what the manual calls UNDEFINED or UNPREDICTABLE becomes
// kUndefined (a UsageFault at run time), and what a variant lacks is undefined or "no coprocessor" on it.
//
//   const Op op = decode({pc, kCortexM4F, it}, first_halfword, second_halfword);
//
// Source: DDI 0403E.e, A5 and A7. The IT block's condition is baked into the operation, so nothing keeps
// ITSTATE at run time; `it` is ITSTATE as it stands when this instruction executes, 0 outside of a block.
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/core/op.h"
#include "firmware_iface/mcu/core/variant.h"

namespace omnihil::mcu {

struct DecodeContext {
  std::uint32_t pc;
  const Variant& variant;
  std::uint8_t it = 0;

  bool in_it() const { return it != 0; }
  bool mid_it() const { return (it & 7) != 0; }  // in a block and not its last: no branch is allowed here
  bool dsp() const { return variant.arch == Arch::kV7EM; }
  bool v7() const { return variant.arch != Arch::kV6M; }
  std::uint32_t literal_base() const { return (pc + 4) & ~3u; }
};

// ITSTATE of the instruction after one that executes with `it`.
inline std::uint8_t it_next(std::uint8_t it) {
  return (it & 7) == 0 ? 0 : static_cast<std::uint8_t>((it & 0xE0) | (it << 1 & 0x1F));
}
inline bool is_wide(std::uint16_t first) { return first >> 11 >= 29; }
inline bool is_it(std::uint16_t first) { return (first & 0xFF00) == 0xBF00 && (first & 15) != 0; }

// Cost is not filled in.
Op decode(const DecodeContext& at, std::uint16_t first, std::uint16_t second);

// Parts by group of encodings; each fills `op` and returns true, or leaves the code to be undefined.
bool decode_narrow(const DecodeContext& at, std::uint32_t h, Op& op);
bool decode_data_shifted(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);
bool decode_data_immediate(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);
bool decode_data_register(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);
bool decode_multiply(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);
bool decode_branch_misc(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);
bool decode_single_access(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);
bool decode_multiple_access(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);
bool decode_coprocessor(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op);

// Bits of an instruction, and the registers that wide encodings may not name.
constexpr std::uint32_t bits(std::uint32_t value, int high, int low) {
  return value >> low & ((1u << (high - low + 1)) - 1);
}
constexpr bool bit(std::uint32_t value, int at) { return value >> at & 1; }
constexpr std::uint8_t u8(std::uint32_t value) { return static_cast<std::uint8_t>(value); }
constexpr bool bad(std::uint32_t reg) { return reg == 13 || reg == 15; }

using OperandForm = int;  // offset within a family of ALU_OP
inline constexpr OperandForm kFormImm = 0, kFormReg = 2, kFormShift = 4;
constexpr Code alu(Code family, OperandForm form, bool set_flags) {
  return static_cast<Code>(family + form + (set_flags ? 1 : 0));
}
constexpr Code test(Code family, OperandForm form) { return static_cast<Code>(family + form / 2); }
constexpr Code offset(Code family, std::uint32_t by) { return static_cast<Code>(family + by); }

}  // namespace omnihil::mcu
