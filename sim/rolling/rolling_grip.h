// Floor force over slip speed of one wheel of a robot that rolls (rolling_robot.h): rolling, or a tyre's curve.
//
//   Grip<double> g{.rolls = false, .load_N = 5.4, .full_grip_m_s = 0.02, .shape = {0.75, 0.6, 4.0}};
//   g.force(0.01);      // 5.4 N x 0.75 x (3/2 x - 1/2 x^3), x = 0.5
//
// The curve is tyre.h's over the share of the extremum's slip speed. Rolling is a line so steep that 1 N
// slides 1 um/s. Force here is positive with positive slip (hub faster than rim): the floor pushes by minus
// it.
#pragma once
#include <algorithm>
#include <cmath>

#include "sim/law/scalar.h"

namespace omnihil {

inline constexpr double kRollingStiffness_N_s_per_m = 1e6;  // of a wheel that rolls: 1 N slides 1 um/s

template <typename T>
T absolute(const T& x) {
  return value_of(x) < 0.0 ? T(-x) : x;
}

// tyre.h, over the share x of the extremum's slip.
template <typename T>
struct TyreShape {
  T peak = T(0), last = T(0);  // friction coefficients
  T last_part = T(1);          // the asymptote's slip over the extremum's

  TyreShape<double> values() const { return {value_of(peak), value_of(last), value_of(last_part)}; }
  T coefficient(const T& x) const {
    if (value_of(x) <= 1.0) return peak * x * (1.5 - 0.5 * x * x);
    if (value_of(x) >= value_of(last_part)) return last;
    const T y = (x - 1.0) / (last_part - 1.0);
    return peak + (last - peak) * y * y * (3.0 - 2.0 * y);
  }
  double coefficient_slope(double x) const {
    const double p = value_of(peak), l = value_of(last), part = value_of(last_part);
    if (x <= 1.0) return p * 1.5 * (1.0 - x * x);
    if (x >= part) return 0.0;
    const double y = (x - 1.0) / (part - 1.0);
    return (l - p) * 6.0 * y * (1.0 - y) / (part - 1.0);
  }
};

// Floor force over slip speed of one wheel, and its slope: rolling, or the tyre's curve.
template <typename T>
struct Grip {
  bool rolls = true;
  T load_N = T(0);
  T full_grip_m_s = T(0);  // slip speed at the curve's extremum
  TyreShape<T> shape;

  double force(double slip_m_s) const {
    if (rolls) return kRollingStiffness_N_s_per_m * slip_m_s;
    const double x = std::abs(slip_m_s) / value_of(full_grip_m_s);
    return std::copysign(value_of(load_N) * shape.values().coefficient(x), slip_m_s);
  }
  double slope(double slip_m_s) const {
    if (rolls) return kRollingStiffness_N_s_per_m;
    const double scale = value_of(full_grip_m_s);
    return value_of(load_N) * shape.values().coefficient_slope(std::abs(slip_m_s) / scale) / scale;
  }
  // At no slip, of a curve: its steepest. kRollingStiffness_N_s_per_m where it rolls.
  T slope_at_rest() const {
    return rolls ? T(kRollingStiffness_N_s_per_m) : T(1.5 * load_N * shape.peak / full_grip_m_s);
  }
  // With what the curve's numbers carry. A wheel that rolls, with an unknown compliance of value zero behind
  // it:  s = F / K + v_c f^-1(F / N)
  T force_of(const T& slip_m_s) const {
    if (!rolls) {
      const T x = absolute(slip_m_s) / full_grip_m_s;
      const T size = load_N * shape.coefficient(x);
      return value_of(slip_m_s) < 0.0 ? T(-size) : size;
    }
    if (is_exactly(full_grip_m_s, 0.0)) return kRollingStiffness_N_s_per_m * slip_m_s;
    const double force_N = kRollingStiffness_N_s_per_m * value_of(slip_m_s);
    const double used = force_N / (value_of(shape.peak) * value_of(load_N) + 1e-300);
    // x (3 - x^2) / 2 = y  =>  x = 2 sin(asin(y) / 3)
    const double share = 2.0 * std::sin(std::asin(std::clamp(used, -1.0, 1.0)) / 3.0);
    return kRollingStiffness_N_s_per_m * (slip_m_s - share * full_grip_m_s);
  }
};

// Dry friction takes `level` off the size of y, down to standstill.
template <typename T>
T shrunk(const T& y, const T& level_up, const T& level_down) {
  if (value_of(y) > value_of(level_up)) return y - level_up;
  if (value_of(y) < -value_of(level_down)) return y + level_down;
  return T(0);
}

}  // namespace omnihil
