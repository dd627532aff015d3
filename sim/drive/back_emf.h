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
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/drive/phase_motor.h"

namespace omnihil {

namespace back_emf_detail {
// x in turns, -0.75 < x < 1.25; `slope` is 2 pi / r. Without a branch: sectors come in no order over many
// motors.
inline double trapezoid(double x, double slope) {
  // -t / (2 pi) = |z - 1/2| - 1/4, z = x + 1/4 wrapped to 0 .. 1; the inner minimum is that wrapping
  const double away = std::abs(x - 0.25);
  const double level = (std::min(away, std::abs(1.0 - away)) - 0.25) * slope;
  return std::max(-1.0, std::min(1.0, level));
}
}  // namespace back_emf_detail

// 2 pi / r of a trapezoid.
inline double trapezoid_slope(const BackEmf& e) {
  return 4.0 * std::numbers::pi / (std::numbers::pi - e.flat_top_rad);
}

inline std::array<double, 3> sine_shape(double theta_elec_rad) {
  const double s = std::sin(theta_elec_rad), c = std::cos(theta_elec_rad);
  // -sin(x - 120) = sin x / 2 + cos x sqrt(3) / 2
  const double half_root3_c = 0.5 * std::numbers::sqrt3 * c;
  return {-s, 0.5 * s + half_root3_c, 0.5 * s - half_root3_c};
}

inline std::array<double, 3> trapezoid_shape(double theta_elec_rad, double slope) {
  const double turns = theta_elec_rad * (0.5 / std::numbers::pi);
  double a = turns - static_cast<double>(static_cast<long long>(turns));
  if (a < 0.0) a += 1.0;
  using back_emf_detail::trapezoid;
  return {trapezoid(a, slope), trapezoid(a - 1.0 / 3.0, slope), trapezoid(a - 2.0 / 3.0, slope)};
}

inline std::array<double, 3> back_emf_shape(const BackEmf& e, double theta_elec_rad) {
  return e.shape == BackEmfShape::kSine ? sine_shape(theta_elec_rad)
                                        : trapezoid_shape(theta_elec_rad, trapezoid_slope(e));
}

}  // namespace omnihil
