// One sub-step of the winding: exact for resistance, inductance, constants and voltage held over it, with the
// mean current as a linear function of the mean speed so that winding and rotor are solved together.
//
//   WindingStep<double> w = make_winding_step(1.2, 5.6e-4, 5.6e-4 / 50e-6, 50e-6 / 5.6e-4);
//   double mean_A = w.mean_current(u - e0, i0) - w.gain * k_V_s_per_rad * mean_omega_rad_s;
//
// Law: L di/dt = u - e0 - k omega - R i.  With everything but i held:
//   i(h) = i_inf + (i_0 - i_inf) e,       e = exp(-R h / L),      i_inf = (u - e0 - k omega) / R
//   mean i = i_inf + (i_0 - i_inf) phi,   phi = (1 - e) L / (R h)
// L = 0: the current follows at once (e = phi = 0). Taking omega as its mean over the sub-step makes the
// whole second order in h; and k omega_mean i_mean is the power that leaves the winding and enters the rotor,
// exactly.
#pragma once
#include <cmath>

#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct WindingStep {
  T resistance_ohm = T(0);
  T conductance_per_ohm = T(0);
  T inductance_H = T(0);
  T decay = T(0);       // e
  T mean_decay = T(0);  // phi
  T gain = T(0);        // (1 - phi) / R

  // Mean and end current for a voltage net of back-EMF.
  T mean_current(const T& net_voltage_V, const T& current_A) const {
    return gain * net_voltage_V + mean_decay * current_A;
  }
  T end_current(const T& net_voltage_V, const T& current_A) const {
    const T settled_A = net_voltage_V * conductance_per_ohm;
    return settled_A + (current_A - settled_A) * decay;
  }
};

// `inductance_over_step` is L / h, `step_over_inductance` h / L (not looked at without inductance).
template <typename T>
[[gnu::always_inline]] inline WindingStep<T> make_winding_step(const T& resistance_ohm, const T& inductance_H,
                                                               const T& inductance_over_step,
                                                               const T& step_over_inductance) {
  using std::exp;
  WindingStep<T> s;
  s.resistance_ohm = resistance_ohm;
  s.conductance_per_ohm = 1.0 / resistance_ohm;
  s.inductance_H = inductance_H;
  const T time_constants = inductance_over_step * s.conductance_per_ohm;  // L / (R h)
  if (value_of(inductance_H) > 0.0) {
    // e = exp(-R h / L), straight from R: in a warming winding everything after waits for it
    const T x = resistance_ohm * step_over_inductance;
    s.decay = exp(-x);
    // (1 - e) / x, by its series where the difference would cancel
    s.mean_decay = value_of(x) < 1e-4 ? T(1.0 - x * (0.5 - x / 6.0)) : T((1.0 - s.decay) * time_constants);
  } else {
    // phi -> L / (R h) for L -> 0: zero, but not its derivative
    s.mean_decay = time_constants;
  }
  s.gain = (1.0 - s.mean_decay) * s.conductance_per_ohm;
  return s;
}

}  // namespace omnihil
