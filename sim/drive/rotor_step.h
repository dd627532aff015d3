// One sub-step of a rotor with dry friction that really holds.
//
//   RotorStep<double> r = advance_rotor(w0, h, RotorLoad<double>{J, tau_Nm, b, b, c, c});
//   r.omega_end_rad_s; r.mean_omega_rad_s; r.held;
//
// Law: J domega/dt = tau - d omega - F sgn(omega), sticking where |tau| <= F; d and F may differ by
// direction. Method: implicit midpoint (second order, no step too long, energy exact: J (w1^2 - w0^2)/2 = h
// w_mid sum of torques). Where the speed crosses zero against friction the sub-step is parted there: the
// rotor stops exactly at zero and stays, or starts in the other direction with the rest of the sub-step. The
// result is continuous in every parameter and has a derivative but at the crossing itself.
#pragma once
#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct RotorLoad {
  T inertia_kg_m2;
  T torque_Nm;  // at zero speed
  T damping_positive_Nm_s_per_rad;
  T damping_negative_Nm_s_per_rad;
  T friction_positive_Nm;
  T friction_negative_Nm;
};

template <typename T>
struct RotorStep {
  T omega_end_rad_s = T(0);
  T mean_omega_rad_s = T(0);
  bool held = false;  // by friction, over the whole sub-step
};

// From rest, over h: holds or starts.
template <typename T>
[[gnu::noinline]] RotorStep<T> start_rotor(T h_s, RotorLoad<T> load) {
  const double tau = value_of(load.torque_Nm);
  RotorStep<T> r;
  if (tau <= value_of(load.friction_positive_Nm) && tau >= -value_of(load.friction_negative_Nm)) {
    r.held = true;
    return r;
  }
  const bool positive = tau > 0.0;
  const T drive_Nm =
      positive ? load.torque_Nm - load.friction_positive_Nm : load.torque_Nm + load.friction_negative_Nm;
  const T& damping = positive ? load.damping_positive_Nm_s_per_rad : load.damping_negative_Nm_s_per_rad;
  // w_mid (2 J / h + d) = tau - F sgn
  r.mean_omega_rad_s = drive_Nm * h_s / (2.0 * load.inertia_kg_m2 + damping * h_s);
  r.omega_end_rad_s = 2.0 * r.mean_omega_rad_s;
  return r;
}

template <typename T>
[[gnu::always_inline]] inline RotorStep<T> advance_rotor(const T& omega_rad_s, double h_s,
                                                         const RotorLoad<T>& load) {
  const double w0 = value_of(omega_rad_s);
  if (w0 == 0.0) [[unlikely]]
    return start_rotor(T(h_s), load);
  const bool positive = w0 > 0.0;
  const T drive_Nm =
      positive ? load.torque_Nm - load.friction_positive_Nm : load.torque_Nm + load.friction_negative_Nm;
  const T& damping = positive ? load.damping_positive_Nm_s_per_rad : load.damping_negative_Nm_s_per_rad;
  const T twice_inertia = 2.0 * load.inertia_kg_m2;
  RotorStep<T> r;
  // w_mid (2 J / h + d) = 2 J w_0 / h + tau - F sgn(w_0)
  r.mean_omega_rad_s = (twice_inertia * omega_rad_s + drive_Nm * h_s) / (twice_inertia + damping * h_s);
  r.omega_end_rad_s = 2.0 * r.mean_omega_rad_s - omega_rad_s;
  const double w1 = value_of(r.omega_end_rad_s);
  const bool crosses = positive ? w1 < 0.0 : w1 > 0.0;
  const bool dry = value_of(load.friction_positive_Nm) > 0.0 || value_of(load.friction_negative_Nm) > 0.0;
  if (!crosses || !dry) [[likely]]
    return r;
  // Stops after t = h w_0 / (w_0 - w_1), having turned by w_0 t / 2.
  const T stop_s = h_s * omega_rad_s / (omega_rad_s - r.omega_end_rad_s);
  const T rest_s = h_s - stop_s;
  const RotorStep<T> rest = start_rotor(rest_s, load);
  r.omega_end_rad_s = rest.omega_end_rad_s;
  r.mean_omega_rad_s = (0.5 * omega_rad_s * stop_s + rest.mean_omega_rad_s * rest_s) / h_s;
  return r;
}

}  // namespace omnihil
