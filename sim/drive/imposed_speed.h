// One sub-step of a rotor whose speed a bench imposes: the torque that the bench must add.
//
//   ImposedSpeed<double> b = impose_speed(w0, w1, h, J, tau_outside_Nm, load);   // b.outside_Nm, b.held
//
// Law: tau_outside = J domega/dt - (all other torques), friction at rest taking what it can.
// Values in, values out, and never inlined: a drive's sub-step that lent its own numbers by reference to a
// case this rare would have to keep them in memory (drive_sim.cc).
#pragma once
#include "sim/drive/rotor_step.h"
#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct ImposedSpeed {
  T outside_Nm = T(0);
  bool held = false;  // at rest, by friction alone
};

template <typename T>
[[gnu::noinline, gnu::cold]] ImposedSpeed<T> impose_speed(double omega_start_rad_s, double omega_end_rad_s,
                                                          double h_s, T inertia_kg_m2, T tau_outside_Nm,
                                                          RotorLoad<T> load) {
  ImposedSpeed<T> r;
  const T mean_omega = T(0.5 * (omega_start_rad_s + omega_end_rad_s));
  const double direction = sign_of(mean_omega);
  T inside = load.torque_Nm - tau_outside_Nm;
  if (direction > 0.0) {
    inside -= load.friction_positive_Nm + load.damping_positive_Nm_s_per_rad * mean_omega;
  } else if (direction < 0.0) {
    inside += load.friction_negative_Nm - load.damping_negative_Nm_s_per_rad * mean_omega;
  } else if (inside > load.friction_positive_Nm) {
    inside -= load.friction_positive_Nm;
  } else if (inside < -load.friction_negative_Nm) {
    inside += load.friction_negative_Nm;
  } else {
    inside = T(0);
    r.held = true;
  }
  r.outside_Nm = inertia_kg_m2 * ((omega_end_rad_s - omega_start_rad_s) / h_s) - inside;
  return r;
}

}  // namespace omnihil
