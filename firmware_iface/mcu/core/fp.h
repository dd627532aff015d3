// What the FPU does where the host's arithmetic is not it: NaNs, conversions, roundings (DDI 0403E.e A2.5,
// A2.7).
//
//   float x = a + b;
//   if (x != x) x = fp_nan(a, b, fpscr);
//
// The host adds, multiplies, divides, takes roots and fuses in IEEE 754 with the same rounding; only the NaN
// that comes out differs.
#pragma once
#include <cstdint>

namespace omnihil::mcu {

enum FpRounding : unsigned { kTiesAway = 0, kTiesEven = 1, kUp = 2, kDown = 3, kByFpscr = 4, kToZero = 5 };
inline constexpr std::uint32_t kDefaultNan = 1u << 25;   // FPSCR.DN
inline constexpr std::uint32_t kFlushToZero = 1u << 24;  // FPSCR.FZ

// A denormal number as a zero of its sign. Results are flushed after rounding, the core's before: a product
// or quotient that rounds up to the smallest normal number stays.
float fp_flush(float value);
double fp_flush(double value);

// The NaN that an operation on these operands gives, in the order in which the manual looks at them.
float fp_nan(float a, float b, std::uint32_t fpscr);
double fp_nan(double a, double b, std::uint32_t fpscr);
// a + b * c fused.
float fp_fused(float a, float b, float c, std::uint32_t fpscr);
double fp_fused(double a, double b, double c, std::uint32_t fpscr);

float fp_max(float a, float b, std::uint32_t fpscr);
double fp_max(double a, double b, std::uint32_t fpscr);
float fp_min(float a, float b, std::uint32_t fpscr);
double fp_min(double a, double b, std::uint32_t fpscr);
float fp_round(float value, FpRounding rounding, std::uint32_t fpscr);
double fp_round(double value, FpRounding rounding, std::uint32_t fpscr);

// N, Z, C, V of a comparison in bits 31 to 28.
template <class F>
std::uint32_t fp_compare(F a, F b) {
  return (a == b ? 6u : a < b ? 8u : a > b ? 2u : 3u) << 28;
}
// Saturating; NaN gives 0.
std::uint32_t fp_to_int(double value, bool is_unsigned, unsigned bits, FpRounding rounding);
std::uint16_t fp_to_half(double value, std::uint32_t fpscr);
double fp_from_half(std::uint16_t value, std::uint32_t fpscr);
float fp_narrow(double value, std::uint32_t fpscr);
float fp_nearest(double value);  // whatever FPSCR says of rounding: fixed point becomes floating point so
double fp_widen(float value, std::uint32_t fpscr);

}  // namespace omnihil::mcu
