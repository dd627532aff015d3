// The current at the end of a sub-step where the voltage depends on it: i = g(i), g(i) = the winding's end current
// under the voltage at i.
//
//   const double i_A = implicit_current(0.0, [](double i) { return 2.0 - 0.4 * i / std::hypot(i, 0.1); });
//
// Why: a dead time turns over with the current's sign. With the current of the sub-step before, a winding of little
// or no inductance swings from one side to the other, and its mean shows no dead time where |u - k omega| is below
// it, where in truth no current flows.
// Method: backward Euler in the law's argument, which stays at rest where the law is steep (a midpoint would swing). The
// argument g(start) where g is flat (|g'| <= 1/2: repeated, it converges) and differs from it there by no more than the
// sub-step's own error. Else start and g(start)
// bracket the solution, since a voltage lost against the current makes g fall: regula falsi (Illinois, Dowell, Jarratt
// 1971), every third step a bisection. The law is called last at what is returned.
// Derivatives by the implicit function theorem, di = dg / (1 - g').
// Cannot: solve a law whose voltage grows with the current faster than the resistance takes (g' >= 1); there the
// current at the start stands.
#pragma once
#include <cmath>
#include <type_traits>

#include "sim/law/scalar.h"

namespace omnihil {

template <typename T, typename Law>
T implicit_current(const T& start, const Law& law) {
  constexpr int kMostSteps = 60;       // 20 bisections among them
  constexpr double kRelative = 1e-10;  // of the bracket's currents: far below the error of a sub-step
  constexpr double kLeast_A = 1e-13;
  // Difference of argument and current, of the currents, that is left where the law is flat: a tenth of the error that
  // a sub-step of a twentieth of a time constant has (a choice; the error of the voltage is this times g').
  constexpr double kHardly = 1e-3;
  // Step of a difference quotient: the root of the rounding, of a law's narrowest width (1 mA) or the current.
  constexpr double kBeside = 1e-7, kLeastBeside_A = 1e-3;
  struct At {
    double i, excess, next;  // A; excess = i - g(i), which the regula falsi may halve
  };
  const auto at = [&](double i) {
    const double next = value_of(law(T(i)));
    return At{i, i - next, next};
  };
  At a = at(value_of(start));
  const double beside = kBeside * (std::abs(a.i) + kLeastBeside_A);
  At b = at(a.next);
  double x = b.i;
  const double currents = std::abs(a.i) + std::abs(b.i);
  const bool flat = std::abs(b.excess) <= 0.5 * std::abs(a.excess);  // g' = -b.excess / a.excess
  if (!flat || std::abs(b.excess) > kHardly * currents) {
    const double enough = kRelative * currents + kLeast_A;
    for (int k = 0; k < kMostSteps && std::abs(b.excess) > enough; ++k) {
      const double slope = (b.next - a.next) / (b.i - a.i);  // g'
      const bool bracketed = a.excess * b.excess < 0.0, bisect = bracketed && k % 3 == 2;
      if (!bracketed && !(slope < 1.0)) {
        x = value_of(start);
        at(x);
        break;
      }
      const At c = at(bisect ? 0.5 * (a.i + b.i) : b.i - b.excess * (b.i - a.i) / (b.excess - a.excess));
      if (c.i == x) break;
      x = c.i;
      if (!bracketed || c.excess * b.excess < 0.0) {
        a = b;
      } else if (!bisect) {
        a.excess *= 0.5;
      }
      b = c;
    }
  }
  if constexpr (std::is_same_v<T, double>) {
    return x;
  } else {
    T i = law(T(x));
    const double slope = (value_of(law(T(x + beside))) - i.a) / beside;
    if (slope < 1.0) i.v /= 1.0 - slope;
    i.a = x;
    law(i);
    return i;
  }
}

}  // namespace omnihil
