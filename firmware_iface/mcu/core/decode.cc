#include "firmware_iface/mcu/core/decode.h"

namespace omnihil::mcu {
namespace {

// 32-bit instructions of v6-M: BL, MSR, MRS, DSB, DMB, ISB.
bool in_v6m(std::uint32_t h, std::uint32_t g) {
  if ((h & 0xF800) != 0xF000 || !bit(g, 15)) return false;
  return (g & 0x5000) == 0x5000 || (h & 0xFFF0) == 0xF380 || h == 0xF3EF ||
         (h == 0xF3BF && (g & 0xFFF0) != 0x8F20);
}

bool decode_wide(const DecodeContext& at, std::uint32_t h, std::uint32_t g, Op& op) {
  if (!at.v7() && !in_v6m(h, g)) return false;
  if ((h & 0xEC00) == 0xEC00) return decode_coprocessor(at, h, g, op);
  switch (h >> 9) {
    case 0x74:
      return decode_multiple_access(at, h, g, op);
    case 0x75:
      return decode_data_shifted(at, h, g, op);
    case 0x7C:
      return decode_single_access(at, h, g, op);
    case 0x7D:
      return bit(h, 8) ? decode_multiply(at, h, g, op) : decode_data_register(at, h, g, op);
    default:
      break;
  }
  return bit(g, 15) ? decode_branch_misc(at, h, g, op) : decode_data_immediate(at, h, g, op);
}

}  // namespace

Op decode(const DecodeContext& at, std::uint16_t first, std::uint16_t second) {
  Op op;
  op.it = at.it;
  op.condition = at.in_it() ? u8(at.it >> 4) : kAlways;
  op.halfwords = is_wide(first) ? 2 : 1;
  const bool known = is_wide(first) ? decode_wide(at, first, second, op) : decode_narrow(at, first, op);
  if (!known && op.code != kNoCoprocessor) op.code = kUndefined;
  return op;
}

}  // namespace omnihil::mcu
