#include "firmware_iface/mcu/rp2040/rom_floats.h"

#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

namespace omnihil::mcu::rp2040 {
namespace {
enum Place : unsigned {
  kAdd,
  kSub,
  kMul,
  kDiv,
  kCompare,
  kCompareFlags,
  kSqrt,
  kToInt,
  kToFix,
  kToUint,
  kToUfix,
  kFromInt,
  kFromFix,
  kFromUint,
  kFromUfix,
  kCos,
  kSin,
  kTan,
  kSinCos,
  kExp,
  kLn,
  kCompareBasic,
  kAtan2,
  kFromInt64,
  kFromFix64,
  kFromUint64,
  kFromUfix64,
  kToInt64,
  kToFix64,
  kToUint64,
  kToUfix64,
  kOther  // float to double, double to float
};
// Of float, of double; datasheet §2.8.3.2 for the arithmetic, the rest a guess.
constexpr unsigned kCycles[kRomFloats][2] = {
    {71, 99},    {74, 99},    {69, 155},   {71, 184},  {34, 45},   {34, 45}, {63, 169},   {37, 75},
    {39, 85},    {38, 75},    {39, 85},    {55, 69},   {55, 75},   {54, 66}, {54, 72},    {577, 1618},
    {587, 1617}, {653, 1891}, {650, 1700}, {451, 804}, {403, 428}, {34, 45}, {599, 2168}, {62, 81},
    {65, 85},    {62, 81},    {65, 85},    {62, 85},   {65, 90},   {60, 85}, {65, 90},    {23, 23}};

template <class Real>
Real flushed(Real x) {
  return std::fpclassify(x) == FP_SUBNORMAL ? std::copysign(Real{0}, x) : x;
}

template <class Real>
struct Operands {
  static constexpr bool kWide = sizeof(Real) == 8;
  RomWords& words;

  std::uint64_t word64(unsigned at) const { return words[at] | std::uint64_t{words[at + 1]} << 32; }
  Real real(unsigned which) const {
    if constexpr (kWide)
      return flushed(std::bit_cast<double>(word64(2 * which)));
    else
      return flushed(std::bit_cast<float>(words[which]));
  }
  // Fraction bits of a conversion stand behind its operand.
  int bits(unsigned operand_words) const { return static_cast<int>(words[operand_words]); }
  unsigned put(Real x, unsigned which = 0) const {
    x = flushed(x);
    if constexpr (kWide) {
      put64(std::bit_cast<std::uint64_t>(x), 2 * which);
      return 2;
    } else {
      words[which] = std::bit_cast<std::uint32_t>(x);
      return 1;
    }
  }
  void put64(std::uint64_t x, unsigned at = 0) const {
    words[at] = static_cast<std::uint32_t>(x);
    words[at + 1] = static_cast<std::uint32_t>(x >> 32);
  }
  // Down, to the bounds of the integer.
  template <class Integer>
  unsigned integer(Real x) const {
    using Limits = std::numeric_limits<Integer>;
    x = std::floor(x);
    const Real over = std::ldexp(Real{1}, std::is_signed_v<Integer> ? Limits::digits : Limits::digits);
    Integer value = 0;
    if (x >= over)
      value = Limits::max();
    else if (std::is_signed_v<Integer> ? x < -over : !(x > 0))
      value = Limits::min();
    else if (!std::isnan(x))
      value = static_cast<Integer>(x);
    if constexpr (sizeof(Integer) == 8) {
      put64(static_cast<std::uint64_t>(value));
      return 2;
    } else {
      words[0] = static_cast<std::uint32_t>(value);
      return 1;
    }
  }
};

template <class Real>
RomResult compute(unsigned place, RomWords& words) {
  const Operands<Real> is{words};
  constexpr unsigned kSize = sizeof(Real) / 4;
  RomResult result{1, place < kRomFloats ? kCycles[place][sizeof(Real) / 8] : 0, 2};
  const auto scaled = [&](int by) { return std::ldexp(is.real(0), by); };
  switch (place) {
    case kAdd:
      result.words = is.put(is.real(0) + is.real(1));
      break;
    case kSub:
      result.words = is.put(is.real(0) - is.real(1));
      break;
    case kMul:
      result.words = is.put(is.real(0) * is.real(1));
      break;
    case kDiv:
      result.words = is.put(is.real(0) / is.real(1));
      break;
    case kCompare:
    case kCompareFlags:
    case kCompareBasic: {
      const Real a = is.real(0), b = is.real(1);
      const int order = a < b ? -1 : a > b ? 1 : 0;
      if (place == kCompareFlags) result.order = order;
      words[0] = static_cast<std::uint32_t>(order);
      break;
    }
    case kSqrt:
      result.words = is.put(std::sqrt(is.real(0)));
      break;
    case kToInt:
      result.words = is.template integer<std::int32_t>(is.real(0));
      break;
    case kToFix:
      result.words = is.template integer<std::int32_t>(scaled(is.bits(kSize)));
      break;
    case kToUint:
      result.words = is.template integer<std::uint32_t>(is.real(0));
      break;
    case kToUfix:
      result.words = is.template integer<std::uint32_t>(scaled(is.bits(kSize)));
      break;
    case kToInt64:
      result.words = is.template integer<std::int64_t>(is.real(0));
      break;
    case kToFix64:
      result.words = is.template integer<std::int64_t>(scaled(is.bits(kSize)));
      break;
    case kToUint64:
      result.words = is.template integer<std::uint64_t>(is.real(0));
      break;
    case kToUfix64:
      result.words = is.template integer<std::uint64_t>(scaled(is.bits(kSize)));
      break;
    case kFromInt:
      result.words = is.put(static_cast<Real>(static_cast<std::int32_t>(words[0])));
      break;
    case kFromFix:
      result.words = is.put(std::ldexp(static_cast<Real>(static_cast<std::int32_t>(words[0])), -is.bits(1)));
      break;
    case kFromUint:
      result.words = is.put(static_cast<Real>(words[0]));
      break;
    case kFromUfix:
      result.words = is.put(std::ldexp(static_cast<Real>(words[0]), -is.bits(1)));
      break;
    case kFromInt64:
      result.words = is.put(static_cast<Real>(static_cast<std::int64_t>(is.word64(0))));
      break;
    case kFromFix64:
      result.words =
          is.put(std::ldexp(static_cast<Real>(static_cast<std::int64_t>(is.word64(0))), -is.bits(2)));
      break;
    case kFromUint64:
      result.words = is.put(static_cast<Real>(is.word64(0)));
      break;
    case kFromUfix64:
      result.words = is.put(std::ldexp(static_cast<Real>(is.word64(0)), -is.bits(2)));
      break;
    case kCos:
      result.words = is.put(std::cos(is.real(0)));
      break;
    case kSin:
    case kSinCos: {  // with the cosine behind it
      const Real angle = is.real(0);
      result.words = is.put(std::sin(angle)) + is.put(std::cos(angle), 1);
      break;
    }
    case kTan:
      result.words = is.put(std::tan(is.real(0)));
      break;
    case kExp:
      result.words = is.put(std::exp(is.real(0)));
      break;
    case kLn:
      result.words = is.put(std::log(is.real(0)));
      break;
    case kAtan2:
      result.words = is.put(std::atan2(is.real(0), is.real(1)));
      break;
    case kOther:
      if constexpr (sizeof(Real) == 4) {
        is.put64(std::bit_cast<std::uint64_t>(static_cast<double>(is.real(0))));
        result.words = 2;
      } else {
        words[0] = std::bit_cast<std::uint32_t>(flushed(static_cast<float>(is.real(0))));
      }
      break;
    default:
      break;
  }
  return result;
}
}  // namespace

RomResult rom_float(unsigned place, RomWords& words) { return compute<float>(place, words); }
RomResult rom_double(unsigned place, RomWords& words) { return compute<double>(place, words); }

}  // namespace omnihil::mcu::rp2040
