// The two scalar types every law is instantiated for: double simulates, Jet carries derivatives to a fit.
//
//   Jet r(1.2, 0);                      // value 1.2, and it is unknown number 0 of this pass
//   Jet e = exp(-r);                    // e.a the value, e.v[0] = de/dr
//
// A Jet has a fixed width; more unknowns take several passes (strides) of kJetWidth each.
// Source: Ceres Solver's dual numbers (forward-mode automatic differentiation).
#pragma once
#include <ceres/jet.h>

namespace omnihil {

inline constexpr int kJetWidth = 8;
using Jet = ceres::Jet<double, kJetWidth>;

inline double value_of(double x) { return x; }
inline double value_of(const Jet& x) { return x.a; }

// Exactly this number, with no unknown behind it.
inline bool is_exactly(double x, double number) { return x == number; }
inline bool is_exactly(const Jet& x, double number) { return x.a == number && x.v.isZero(0.0); }

// -1, 0 or 1 of the value; its derivative is zero wherever it has one.
template <typename T>
double sign_of(const T& x) {
  return value_of(x) > 0.0 ? 1.0 : (value_of(x) < 0.0 ? -1.0 : 0.0);
}

}  // namespace omnihil
