// The barrel shifter (DDI 0403E.e A7.4.2) and saturation.
#pragma once
#include <bit>
#include <cstdint>

namespace omnihil::mcu {

enum ShiftType : unsigned { kShiftLsl = 0, kShiftLsr = 1, kShiftAsr = 2, kShiftRor = 3, kShiftRrx = 4 };

// `carry` is replaced by the shifter's carry, or left alone for a shift by 0.
inline std::uint32_t shift(std::uint32_t value, unsigned type, std::uint32_t amount, std::uint32_t& carry) {
  if (type == kShiftRrx) {
    const std::uint32_t in = carry;
    carry = value & 1;
    return value >> 1 | in << 31;
  }
  if (amount == 0) return value;
  switch (type) {
    case kShiftLsl:
      carry = amount > 32 ? 0 : value >> (32 - amount) & 1;
      return amount > 31 ? 0 : value << amount;
    case kShiftLsr:
      carry = amount > 32 ? 0 : value >> (amount - 1) & 1;
      return amount > 31 ? 0 : value >> amount;
    case kShiftAsr: {
      const std::uint32_t last = amount > 32 ? 31 : amount - 1;
      carry = static_cast<std::uint32_t>(static_cast<std::int32_t>(value) >> last) & 1;
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(value) >> (amount > 31 ? 31 : amount));
    }
    default: {
      const std::uint32_t result = std::rotr(value, static_cast<int>(amount & 31));
      carry = result >> 31;
      return result;
    }
  }
}

// `value` held to [low, high]; sets `q` to 1 where that changed it.
inline std::uint32_t saturate(std::int64_t value, std::int64_t low, std::int64_t high, std::uint32_t& q) {
  if (value > high) {
    q = 1;
    value = high;
  } else if (value < low) {
    q = 1;
    value = low;
  }
  return static_cast<std::uint32_t>(value);
}
inline std::uint32_t saturate_word(std::int64_t value, std::uint32_t& q) {
  return saturate(value, INT32_MIN, INT32_MAX, q);
}

}  // namespace omnihil::mcu
