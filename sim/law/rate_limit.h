// A set-point that walks to a new target at a largest rate instead of jumping there.
//
//   double x = 0.0;
//   const Walked<double> w = walk_towards(x, 1.0, 0.01, 0.5);      // at 1 / 0.5 per second for 10 ms: x = 0.02
//   const double mean = w.mean - w.lost;                           // 0.01
//
// Law: |dx/dt| <= 1 / q, x at the target otherwise; q = 0: it jumps. Source: Biagiotti, Melchiorri, Trajectory Planning for
// Automatic Machines and Robots, 2008 (constant-velocity profile). Cannot: limits of acceleration.
#pragma once
#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct Walked {
  T mean;  // of x over the step; of a walk that ends within it the target
  T lost;  // what the way of such a walk takes from that: in proportion to q, so that q has a derivative at neutral, too
};

// `x` becomes the value at the step's end. inverse_rate: s per unit of x, >= 0.
template <typename T>
Walked<T> walk_towards(T& x, const T& target, double step_s, const T& inverse_rate) {
  const T before = x, way = target - before;
  const T needed_s = way * sign_of(way) * inverse_rate;
  if (value_of(needed_s) > step_s) {
    // x += sgn(way) h / q
    x = before + sign_of(way) * step_s / inverse_rate;
    return {.mean = 0.5 * (before + x), .lost = T(0)};
  }
  x = target;
  // way (time needed / 2 h)
  return {.mean = target, .lost = way * (0.5 * needed_s / step_s)};
}

}  // namespace omnihil
