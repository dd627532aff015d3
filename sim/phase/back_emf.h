// Shape of the back-EMF of three phases over the electrical angle, between -1 and 1.
//
//   std::array<double, 3> f = back_emf_shape(motor.back_emf, theta_elec_rad);    // e_x = p lambda omega f[x]
//
// Law:  sine: f(x) = -sin x.   Trapezoid: f(x) = -clamp(t(x) / r, -1, 1), t the triangle wave of slope 1 with
// t(0) = 0, r = (pi - flat_top) / 2 the length of a ramp; phases at x, x - 2 pi / 3, x - 4 pi / 3.
// Source: Krause et al. (2002), sec. 15.2; Pillay and Krishnan 1989, "Modeling of permanent magnet motor
// drives", for the trapezoid.
// The three sines sum to zero; the trapezoids do not: what they have in common shifts the star point and
// drives no current.
#pragma once
#include <array>
#include <cmath>
#include <numbers>

#include "sim/phase/phase_motor.h"

namespace omnihil {

namespace back_emf_detail {
// x in turns, 0 <= x < 1; `slope` is 2 pi / r.
inline double trapezoid(double x, double slope) {
  // t / (2 pi): 0 at 0, 1/4 at 1/4, 0 at 1/2, -1/4 at 3/4
  const double quarter = x < 0.25 ? x : (x < 0.75 ? 0.5 - x : x - 1.0);
  const double level = quarter * slope;
  return level > 1.0 ? -1.0 : (level < -1.0 ? 1.0 : -level);
}
}  // namespace back_emf_detail

inline std::array<double, 3> back_emf_shape(const BackEmf& e, double theta_elec_rad) {
  if (e.shape == BackEmfShape::kSine) {
    const double s = std::sin(theta_elec_rad), c = std::cos(theta_elec_rad);
    // -sin(x - 120) = sin x / 2 + cos x sqrt(3) / 2
    const double half_root3_c = 0.5 * std::numbers::sqrt3 * c;
    return {-s, 0.5 * s + half_root3_c, 0.5 * s - half_root3_c};
  }
  const double turns = theta_elec_rad * (0.5 / std::numbers::pi);
  double a = turns - static_cast<double>(static_cast<long long>(turns));
  if (a < 0.0) a += 1.0;
  double b = a - 1.0 / 3.0, c = a - 2.0 / 3.0;
  if (b < 0.0) b += 1.0;
  if (c < 0.0) c += 1.0;
  const double slope = 4.0 * std::numbers::pi / (std::numbers::pi - e.flat_top_rad);
  using back_emf_detail::trapezoid;
  return {trapezoid(a, slope), trapezoid(b, slope), trapezoid(c, slope)};
}

}  // namespace omnihil
