// The motor torque that a motion needs where a law (a gear's loss, a friction that grows with the load) looks
// at the motor torque itself: tau = g(tau), g(tau) = J domega/dt + friction(tau) - load.
//
//   const double tau = needed_torque(0.0, [](double t) { return 2.0 + 0.5 * std::abs(t); });   // 4
//
// Why: in inverse dynamics the motion is imposed and the motor torque is compared with the measured one. A
// law that took the measured torque for its argument would explain any residual by itself (a friction of 99 %
// of the torque leaves 1 % of it), whatever the motion is.
// Method: secant on values (exact in one step where g is piecewise linear and no kink lies between); the
// derivatives by the implicit function theorem, dtau = dg / (1 - g').
// Cannot: choose among several solutions, that a law of slope above 1 has; where none is found within
// kMostSteps the last estimate stands.
#pragma once
#include <cmath>

#include "sim/law/scalar.h"

namespace omnihil {

template <typename T, typename Law>
T needed_torque(const T& start, const Law& law) {
  constexpr int kMostSteps = 20;       // halves the distance at least in each where |g'| <= 1/2
  constexpr double kRounding = 1e-13;  // relative; of a sum of a few torques
  double at = value_of(start), slope = 0.0;
  T last = law(T(at));
  double next = value_of(last);
  double most = std::abs(at) + std::abs(next);
  for (int k = 0; k < kMostSteps && std::abs(next - at) > kRounding * most; ++k) {
    const double before = at, g_before = next;
    at = before + (g_before - before) / (1.0 - slope);
    last = law(T(at));
    next = value_of(last);
    most = std::max(most, std::abs(at) + std::abs(next));
    if (at != before) slope = (next - g_before) / (at - before);
    if (!(slope < 1.0)) slope = 0.0;  // a kink between, or several solutions: plain iteration
  }
  return at + (last - at) / (1.0 - slope);
}

}  // namespace omnihil
