// One sub-step of the shaft between rotor and output: a spring with damping and play, as a linear function of
// the rotor's mean speed, so that rotor, winding, shaft and output are solved together.
//
//   ShaftStep<double> s = make_shaft_step(port, output, 50e-6);
//   double tau_output_Nm = s.torque_Nm + s.damping_Nm_s_per_rad * mean_omega_rotor_rad_s / ratio;
//
// Law: tau = (x -+ gap / 2) / c + d x' in contact, 0 in the play; x = theta_rotor / N - theta_out.
//   implicit midpoint: mean tau = K (x + h mean x' / 2 - side) + D mean x',  A = K h / 2 + D
//   output: mean w_out = w_out + h / (2 J_out) (mean tau + tau_outside), put into the line above
// Source: Nordin, Gutman, Automatica 38(10), 2002 (dead zone model; no pulling contact). Second order;
// without damping energy is kept, the share below aside. A stiff shaft cannot be resolved: to c is added
// h^2 / (4 J), J both masses in parallel (5e-5 s and 6e-6 kg m2: 1e-4 rad/(N m)), and where that dominates
// damping makes contact without bounce.
#pragma once
#include "sim/law/effect_ports.h"
#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct ShaftStep {
  T torque_Nm = T(0);             // at the output, with the rotor at rest
  T damping_Nm_s_per_rad = T(0);  // per rotor speed over gear
};

template <typename T>
struct ShaftOutput {
  T rotor_inertia_kg_m2 = T(0);  // times N^2
  T inertia_kg_m2 = T(0);
  T omega_rad_s = T(0);
  T torque_Nm = T(0);  // from outside
  bool imposed = false;
  T imposed_mean_rad_s = T(0);
};

template <typename T>
ShaftStep<T> make_shaft_step(const ShaftPort<T>& port, const ShaftOutput<T>& out, double h_s) {
  const T x_mid = port.twist_rad + 0.5 * h_s * port.twist_rate_rad_s;
  const T half = 0.5 * port.gap_rad;
  const double side = sign_of(x_mid);
  const bool play = value_of(half) > 0.0;
  if (play && side * value_of(x_mid) <= value_of(half)) return {};
  // K = 1 / (c + h^2 / (4 J)), D = d + (4 J / h) (its share)^4
  const T inertia =
      out.rotor_inertia_kg_m2 * out.inertia_kg_m2 / (out.rotor_inertia_kg_m2 + out.inertia_kg_m2);
  const T least = h_s * h_s / (4.0 * inertia);
  const T stiffness = 1.0 / (port.compliance_rad_per_Nm + least);
  const T share = least * stiffness;
  const T damping = port.damping_Nm_s_per_rad + 4.0 * inertia / h_s * (share * share) * (share * share);
  const T pressed = stiffness * (x_mid - side * half) + damping * port.twist_rate_rad_s;
  if (play && side * value_of(pressed) <= 0.0) return {};  // flanks do not pull
  // mean tau = B + A (mean omega_rotor / N - mean w_out)
  const T a = 0.5 * h_s * stiffness + damping;
  const T b = stiffness * (port.twist_rad - side * half);
  if (out.imposed) return {b - a * out.imposed_mean_rad_s, a};
  const T per_torque = 0.5 * h_s / out.inertia_kg_m2;
  const T scale = 1.0 / (1.0 + a * per_torque);
  return {(b - a * (out.omega_rad_s + per_torque * out.torque_Nm)) * scale, a * scale};
}

}  // namespace omnihil
