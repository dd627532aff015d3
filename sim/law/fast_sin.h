// Sine and cosine for laws that are evaluated every 50 microseconds: a third of the library's time, and the
// same bits on every machine.
//
//   port.tau_Nm += amplitude_Nm * sin_of(order * port.theta_rotor_rad + phase_rad)     // double or Jet
//                  * turning_mean(order * port.omega_rotor_rad_s * port.dt_s);         // its mean over the sub-step
//
// Method: x = k pi + r with |r| <= pi/2, pi in three parts (Cody and Waite 1980), Taylor series of sin r to
// r^19. Within 4e-16 absolute of the true value for |x| up to 1e6, growing as |x| 1e-22 beyond; not for |x|
// over 1e9.
#pragma once
#include <bit>
#include <cstdint>

#include "sim/law/scalar.h"

namespace omnihil {

inline double sin_of(double x) {
  constexpr double kInversePi = 0.31830988618379067154;
  constexpr double kPi1 = 0x1.921fb54400000p+1, kPi2 = 0x1.0b4611a600000p-33, kPi3 = 0x1.3198a2e037073p-68;
  constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest whole number in the low bits
  const double shifted = x * kInversePi + kRound;
  const double k = shifted - kRound;
  const double r = ((x - k * kPi1) - k * kPi2) - k * kPi3;
  const double s = r * r, s2 = s * s, s4 = s2 * s2;
  // sin r = r - r^3/3! + r^5/5! - … + (-1)^n r^(2n+1)/(2n+1)!
  const double low = (-1.0 / 6 + s * (1.0 / 120)) + s2 * (-1.0 / 5040 + s * (1.0 / 362880));
  const double high =
      (-1.0 / 39916800 + s * (1.0 / 6227020800)) +
      s2 * ((-1.0 / 1307674368000 + s * (1.0 / 355687428096000)) - s2 * (1.0 / 121645100408832000));
  const double value = r + r * s * (low + s4 * high);
  const std::uint64_t odd = std::bit_cast<std::uint64_t>(shifted) << 63;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ odd);
}

inline double cos_of(double x) { return sin_of(x + 1.5707963267948966192); }

inline Jet sin_of(const Jet& x) { return Jet(sin_of(x.a), cos_of(x.a) * x.v); }
inline Jet cos_of(const Jet& x) { return Jet(cos_of(x.a), -sin_of(x.a) * x.v); }

// What is left of a sine or cosine as a mean over a turn of `angle` radians about its middle: sin(a/2) /
// (a/2). A sub-step that cannot resolve a ripple then feels what the ripple leaves, not one instant of it.
template <typename T>
T turning_mean(const T& angle_rad) {
  const T x = 0.5 * angle_rad;
  const double size = value_of(x);
  if (size > 0.5 || size < -0.5) return sin_of(x) / x;
  const T s = x * x;  // series to x^8, within 3e-11
  return 1.0 - s * (1.0 / 6) * (1.0 - s * (1.0 / 20) * (1.0 - s * (1.0 / 42) * (1.0 - s * (1.0 / 72))));
}

// Where no unknown is behind the angle (an imposed speed) the same bits without eight derivatives of zero.
inline Jet turning_mean(const Jet& angle_rad) {
  return angle_rad.v.isZero(0.0) ? Jet(turning_mean(angle_rad.a)) : turning_mean<Jet>(angle_rad);
}

}  // namespace omnihil
