#include "firmware_iface/mcu/core/fp.h"

#include <bit>
#include <cfenv>
#include <cmath>
#include <limits>

namespace omnihil::mcu {
namespace {

template <class F>
struct Layout;
template <>
struct Layout<float> {
  using Bits = std::uint32_t;
  static constexpr Bits kQuiet = 1u << 22, kDefault = 0x7FC00000u;
};
template <>
struct Layout<double> {
  using Bits = std::uint64_t;
  static constexpr Bits kQuiet = Bits{1} << 51, kDefault = 0x7FF8000000000000u;
};

template <class F>
typename Layout<F>::Bits bits_of(F value) {
  return std::bit_cast<typename Layout<F>::Bits>(value);
}
template <class F>
bool is_nan(F value) {
  return value != value;
}
template <class F>
bool is_signalling(F value) {
  return is_nan(value) && !(bits_of(value) & Layout<F>::kQuiet);
}
template <class F>
F default_nan() {
  return std::bit_cast<F>(Layout<F>::kDefault);
}
template <class F>
F quiet(F value, std::uint32_t fpscr) {
  return fpscr & kDefaultNan ? default_nan<F>() : std::bit_cast<F>(bits_of(value) | Layout<F>::kQuiet);
}

// FPProcessNaNs: a signalling NaN before a quiet one, the first operand before the second.
template <class F>
F nan_of(F a, F b, std::uint32_t fpscr) {
  if (is_signalling(a)) return quiet(a, fpscr);
  if (is_signalling(b)) return quiet(b, fpscr);
  if (is_nan(a)) return quiet(a, fpscr);
  if (is_nan(b)) return quiet(b, fpscr);
  return default_nan<F>();
}

template <class F>
F fused(F a, F b, F c, std::uint32_t fpscr) {
  const F result = std::fma(b, c, a);
  if (!is_nan(result)) [[likely]]
    return result;
  // FPMulAdd: infinity times zero added to a quiet NaN is the default NaN.
  const bool invalid = (std::isinf(b) && c == 0) || (b == 0 && std::isinf(c));
  if (is_nan(a) && !is_signalling(a) && invalid) return default_nan<F>();
  if (is_signalling(a) || is_signalling(b) || is_signalling(c)) {
    return quiet(is_signalling(a) ? a : is_signalling(b) ? b : c, fpscr);
  }
  if (is_nan(a)) return quiet(a, fpscr);
  return nan_of(b, c, fpscr);
}

template <class F>
F larger(F a, F b, std::uint32_t fpscr, bool want_less) {
  const bool nan_a = is_nan(a), nan_b = is_nan(b);
  if (nan_a || nan_b) {  // maxNum: a number wins over a quiet NaN
    if (is_signalling(a) || is_signalling(b) || (nan_a && nan_b)) return nan_of(a, b, fpscr);
    return nan_a ? b : a;
  }
  if (a == b) return std::signbit(a) == want_less ? a : b;  // -0 is below +0
  return (a < b) == want_less ? a : b;
}

double to_even(double value) {
  const double down = std::floor(value), rest = value - down;
  if (rest != 0.5) return rest < 0.5 ? down : down + 1;
  return std::fmod(down, 2.0) == 0 ? down : down + 1;
}

// Rounded to an integer. The sign is kept by hand: where the host rounds down, its 0 - 0 is -0.
double integral(double value, FpRounding rounding) {
  switch (rounding) {
    case kTiesAway:
      return std::copysign(std::round(value), value);
    case kTiesEven:
      return std::copysign(to_even(value), value);
    case kUp:
      return std::copysign(std::ceil(value), value);
    case kDown:
      return std::copysign(std::floor(value), value);
    case kToZero:
      return std::copysign(std::trunc(value), value);
    default:
      return std::nearbyint(value);
  }
}

}  // namespace

float fp_flush(float value) {
  return std::fpclassify(value) == FP_SUBNORMAL ? std::copysign(0.0f, value) : value;
}
double fp_flush(double value) {
  return std::fpclassify(value) == FP_SUBNORMAL ? std::copysign(0.0, value) : value;
}

float fp_nan(float a, float b, std::uint32_t fpscr) { return nan_of(a, b, fpscr); }
double fp_nan(double a, double b, std::uint32_t fpscr) { return nan_of(a, b, fpscr); }
float fp_fused(float a, float b, float c, std::uint32_t fpscr) { return fused(a, b, c, fpscr); }
double fp_fused(double a, double b, double c, std::uint32_t fpscr) { return fused(a, b, c, fpscr); }
float fp_max(float a, float b, std::uint32_t fpscr) { return larger(a, b, fpscr, false); }
double fp_max(double a, double b, std::uint32_t fpscr) { return larger(a, b, fpscr, false); }
float fp_min(float a, float b, std::uint32_t fpscr) { return larger(a, b, fpscr, true); }
double fp_min(double a, double b, std::uint32_t fpscr) { return larger(a, b, fpscr, true); }

float fp_round(float value, FpRounding rounding, std::uint32_t fpscr) {
  if (is_nan(value)) return quiet(value, fpscr);
  return static_cast<float>(integral(static_cast<double>(value), rounding));
}
double fp_round(double value, FpRounding rounding, std::uint32_t fpscr) {
  return is_nan(value) ? quiet(value, fpscr) : integral(value, rounding);
}

std::uint32_t fp_to_int(double value, bool is_unsigned, unsigned bits, FpRounding rounding) {
  if (is_nan(value)) return 0;
  const double whole = integral(value, rounding);
  const double high = static_cast<double>((std::uint64_t{1} << (is_unsigned ? bits : bits - 1)) - 1);
  const double low = is_unsigned ? 0.0 : -high - 1;
  const double held = whole > high ? high : whole < low ? low : whole;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(held));
}

std::uint16_t fp_to_half(double value, std::uint32_t fpscr) {
  const std::uint64_t raw = bits_of(value);
  const std::uint16_t sign = static_cast<std::uint16_t>(raw >> 48 & 0x8000);
  if (is_nan(value)) {
    if (fpscr & kDefaultNan) return 0x7E00;
    return static_cast<std::uint16_t>(sign | 0x7E00 | (raw >> 42 & 0x1FF));
  }
  const double size = std::fabs(value);
  if (std::isinf(value)) return static_cast<std::uint16_t>(sign | 0x7C00);
  // In steps of the half's last place: 2^-24 below 2^-14, else 2^(exponent - 10). Rounded as the host does
  // now.
  const int exponent = size < std::ldexp(1.0, -14) ? -14 : std::ilogb(size);
  const double steps = std::fabs(std::nearbyint(std::ldexp(value, 10 - exponent)));
  const std::uint32_t whole = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::fmin(steps, 4096.0)));
  const std::uint32_t encoded = static_cast<std::uint32_t>(exponent + 14) * 1024u + whole;
  if (exponent > 15 || encoded >= 0x7C00) {
    const double one = std::nearbyint(sign ? -0.5 : 0.5), other = std::nearbyint(sign ? -1.5 : 1.5);
    const bool towards_zero = one == 0 && std::fabs(other) == 1.0;
    return static_cast<std::uint16_t>(sign | (towards_zero ? 0x7BFF : 0x7C00));
  }
  return static_cast<std::uint16_t>(sign | encoded);
}

double fp_from_half(std::uint16_t value, std::uint32_t fpscr) {
  const bool negative = value >> 15;
  const int exponent = value >> 10 & 31;
  const std::uint32_t fraction = value & 0x3FF;
  if (exponent == 31 && fraction != 0) {
    const std::uint64_t raw =
        (negative ? std::uint64_t{1} << 63 : 0) | 0x7FF0000000000000u | std::uint64_t{fraction} << 42;
    return quiet(std::bit_cast<double>(raw), fpscr);
  }
  double size = std::numeric_limits<double>::infinity();
  if (exponent == 0) {
    size = std::ldexp(static_cast<double>(fraction), -24);
  } else if (exponent < 31) {
    size = std::ldexp(static_cast<double>(fraction + 1024), exponent - 25);
  }
  return negative ? -size : size;
}

float fp_narrow(double value, std::uint32_t fpscr) {
  if (!is_nan(value)) return static_cast<float>(value);
  const std::uint64_t raw = bits_of(quiet(value, fpscr));
  const std::uint32_t narrow = static_cast<std::uint32_t>(raw >> 32 & 0x80000000u) | 0x7FC00000u |
                               static_cast<std::uint32_t>(raw >> 29 & 0x003FFFFF);
  return std::bit_cast<float>(narrow);
}

float fp_nearest(double value) {
  const int mode = std::fegetround();
  if (mode == FE_TONEAREST) return static_cast<float>(value);
  std::fesetround(FE_TONEAREST);
  const volatile float result = static_cast<float>(value);  // before the mode is put back
  std::fesetround(mode);
  return result;
}

double fp_widen(float value, std::uint32_t fpscr) {
  if (!is_nan(value)) return static_cast<double>(value);
  const std::uint64_t raw = bits_of(quiet(value, fpscr));
  return std::bit_cast<double>((raw & 0x80000000u) << 32 | 0x7FF0000000000000u | (raw & 0x007FFFFF) << 29);
}

}  // namespace omnihil::mcu
