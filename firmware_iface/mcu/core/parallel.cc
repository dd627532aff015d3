// Parallel addition and subtraction of bytes and halfwords (DDI 0403E.e A5.3.13, A5.3.14).
#include "firmware_iface/mcu/core/cpu.h"

namespace omnihil::mcu {
namespace {

enum Which : unsigned { kAdd8 = 0, kAdd16 = 1, kAsx = 2, kSub8 = 4, kSub16 = 5, kSax = 6 };

std::int32_t lane(std::uint32_t word, int at, int width, bool is_unsigned) {
  const std::uint32_t raw = word >> (at * width) & ((1u << width) - 1);
  if (is_unsigned) return static_cast<std::int32_t>(raw);
  const std::uint32_t sign = 1u << (width - 1);
  return static_cast<std::int32_t>(raw ^ sign) - static_cast<std::int32_t>(sign);
}

}  // namespace

std::uint32_t parallel_add(std::uint32_t x, std::uint32_t y, unsigned which, unsigned kind,
                           std::uint32_t& ge) {
  const bool is_unsigned = kind >= 4, bytes = which == kAdd8 || which == kSub8;
  const bool crossed = which == kAsx || which == kSax;
  const int lanes = bytes ? 4 : 2, width = 32 / lanes;
  const std::int32_t mask = (1 << width) - 1;
  std::uint32_t result = 0, greater = 0;
  for (int i = 0; i < lanes; ++i) {
    const std::int32_t a = lane(x, i, width, is_unsigned);
    const std::int32_t b = lane(y, crossed ? i ^ 1 : i, width, is_unsigned);
    const bool subtract =
        which == kSub8 || which == kSub16 || (which == kAsx && i == 0) || (which == kSax && i == 1);
    std::int32_t sum = subtract ? a - b : a + b;
    const bool at_least = is_unsigned && !subtract ? sum > mask : sum >= 0;
    if (at_least) greater |= bytes ? 1u << i : 3u << (2 * i);
    if ((kind & 3) == 1) {
      const std::int32_t high = is_unsigned ? mask : mask >> 1, low = is_unsigned ? 0 : -(mask >> 1) - 1;
      sum = sum > high ? high : sum < low ? low : sum;
    } else if ((kind & 3) == 2) {
      sum >>= 1;
    }
    result |= static_cast<std::uint32_t>(sum & mask) << (i * width);
  }
  if ((kind & 3) == 0) ge = greater;
  return result;
}

}  // namespace omnihil::mcu
