// A low pass of the first order, tau dy/dt = u - y, solved exactly over a step: its state is y.
//
//   double y = 0.0;
//   const double mean = lag_behind_held(y, 1.0, 0.01, 0.02);        // u = 1 for 10 ms: y = 1 - exp(-0.5)
//   y = lag_behind_line(y, 1.0, 1.5, 0.01, 0.02);                   // u from 1 to 1.5 in the next 10 ms
//   const double stepped = of_a_loop(y, 1.5, 0.005, 0.02);          // a firmware's, that turns every 5 ms
//
// At tau = 0 both are u, and the derivatives there are those of a delay by tau. Source: solution of the linear equation by
// variation of constants; Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed. 1998 (zero and first order hold).
#pragma once
#include <cmath>

#include "sim/law/scalar.h"

namespace omnihil {

// exp(-h / tau); below double's precision none, so that it and its derivative are defined at tau = 0.
template <typename H, typename T>
T lag_decay(const H& step_s, const T& tau_s) {
  using std::exp;
  constexpr double kGone = 40.0;  // exp(-40) = 4e-18
  if (value_of(tau_s) * kGone < value_of(step_s)) return T(0);
  return value_of(tau_s) > 0.0 ? T(exp(-step_s / tau_s)) : T(1);
}

// u held for a step. Returns the mean of y over it; `y` becomes the value at its end.
template <typename T>
T lag_behind_held(T& y, const T& u, double step_s, const T& tau_s) {
  const T decay = lag_decay(step_s, tau_s);
  const T behind = y - u;
  // y(h) = u + (y0 - u) exp(-h / tau);  mean = u + (y0 - u) (tau / h) (1 - exp(-h / tau))
  y = u + behind * decay;
  return u + behind * (tau_s / step_s) * (1.0 - decay);
}

// u on a line from u0 to u1 over a step. Returns y at its end.
template <typename T>
T lag_behind_line(const T& y0, const T& u0, const T& u1, double step_s, const T& tau_s) {
  const T decay = lag_decay(step_s, tau_s);
  // y(h) = u1 - (u1 - u0) (tau / h) (1 - exp(-h / tau)) + (y0 - u0) exp(-h / tau)
  return u1 - (u1 - u0) * (tau_s / step_s) * (1.0 - decay) + (y0 - u0) * decay;
}

// What a firmware's loop of period P gives for `y`, the solution for the same u: it takes the newest u at once and holds
// y(t + P) for P, which is y(t + P / 2) in the mean, to (P / tau)^2 / 24 of u - y. P = 0: y.
template <typename T>
T of_a_loop(const T& y, const T& u, const T& period_s, const T& tau_s) {
  return u - (u - y) * lag_decay(T(0.5 * period_s), tau_s);
}

// Of a sensor that is read from time to time; between two readings u is on a line.
template <typename T>
struct SampledLag {
  T &y, &last_input, &started;  // states; started: 0 until the first reading, which is taken for settled

  T reading(const T& u, double since_s, const T& tau_s, const T& loop_period_s) {
    y = value_of(started) == 0.0 || since_s <= 0.0 ? u : lag_behind_line(y, last_input, u, since_s, tau_s);
    last_input = u;
    started = T(1);
    return of_a_loop(y, u, loop_period_s, tau_s);
  }
};

}  // namespace omnihil
