// The averaged three-phase motor in the rotor's frame: d along the magnets, q ahead of it.
//
//   DqState<double> x;
//   DqStepResult<double> r = advance_dq(motor, x, {.v_d_V = 0, .v_q_V = 5, .tau_load_Nm = 0.02}, 50e-6);
//   x.i_q_A; x.omega_rotor_rad_s; r.torque_Nm;
//
// Law (amplitude-invariant Park transform):
//   v_d = R i_d + dpsi_d/dt - omega_e psi_q,    v_q = R i_q + dpsi_q/dt + omega_e psi_d,  omega_e = p omega
//   tau = 3/2 p (psi_d i_q - psi_q i_d)         ( = 3/2 p (lambda i_q + (L_d - L_q) i_d i_q) unsaturated)
//   J domega/dt = tau - b omega - tau_load
// Flux linkages from one co-energy W'(i_d, i_q), so that no saturation can make energy:
//   W' = w(L_d, i_d) + w(L_q, i_q) + lambda(i_q) i_d,   psi = grad W',   lambda(i) = lambda / (1 + (s_m i)^2)
//   w'' = L / (1 + (s_L i)^2),  w' = L atan(s_L i) / s_L
// Source: Krause et al. (2002), ch. 3 and 15; Vas 1992, "Electrical Machines and Drives", for co-energy.
// Method: implicit midpoint, two Newton passes, winding and rotor together: second order, stable for any
// step, steady states exact. Unsaturated, energy in = heat + mechanical + stored, to rounding. Templates on
// the scalar. Cannot: PWM ripple, trapezoidal back-EMF, floating phases (switched_drive.h), iron loss,
// cross-saturation but that of the flux law.
#pragma once
#include <cmath>

#include "sim/drive/phase_motor.h"

namespace omnihil {

// Flux linkages and their derivatives by the currents (the differential inductances), and stored energy.
template <typename T>
struct DqFlux {
  T psi_d_Wb, psi_q_Wb;
  T dd_H, dq_H, qq_H;
};

template <typename T>
DqFlux<T> dq_flux(const PhaseMotor<T>& m, const T& i_d, const T& i_q) {
  using std::atan;
  DqFlux<T> f{m.inductance_d_H * i_d + m.flux_linkage_Wb, m.inductance_q_H * i_q, m.inductance_d_H, T(0),
              m.inductance_q_H};
  if (!(m.inductance_saturation_per_A == T(0))) {
    const T s = m.inductance_saturation_per_A, xd = s * i_d, xq = s * i_q;
    // psi = L atan(s i) / s,  dpsi/di = L / (1 + (s i)^2)
    f.psi_d_Wb = m.inductance_d_H * atan(xd) / s + m.flux_linkage_Wb;
    f.psi_q_Wb = m.inductance_q_H * atan(xq) / s;
    f.dd_H = m.inductance_d_H / (1.0 + xd * xd);
    f.qq_H = m.inductance_q_H / (1.0 + xq * xq);
  }
  if (!(m.flux_saturation_per_A == T(0))) {
    const T s2 = m.flux_saturation_per_A * m.flux_saturation_per_A, n = 1.0 + s2 * i_q * i_q;
    // lambda(i_q), its first and second derivative
    const T level = m.flux_linkage_Wb / n, first = -2.0 * s2 * i_q * level / n;
    const T second = 2.0 * s2 * level / n * (4.0 * s2 * i_q * i_q / n - 1.0);
    f.psi_d_Wb += level - m.flux_linkage_Wb;
    f.psi_q_Wb += first * i_d;
    f.dq_H = first;
    f.qq_H += second * i_d;
  }
  return f;
}

// Energy in the magnetic field of the currents: 3/2 (psi . i - W' ), zero at zero current.
template <typename T>
T dq_stored_J(const PhaseMotor<T>& m, const T& i_d, const T& i_q) {
  using std::log;
  const auto axis = [&](const T& L, const T& i) {
    if (m.inductance_saturation_per_A == T(0)) return T(0.5 * L * i * i);
    const T x = m.inductance_saturation_per_A * i;
    // integral of i dpsi = L ln(1 + (s i)^2) / (2 s^2)
    return T(0.5 * L * log(1.0 + x * x) / (m.inductance_saturation_per_A * m.inductance_saturation_per_A));
  };
  const DqFlux<T> f = dq_flux(m, i_d, i_q);
  // the magnets' part: lambda'(i_q) i_d i_q
  return 1.5 * (axis(m.inductance_d_H, i_d) + axis(m.inductance_q_H, i_q) + f.dq_H * i_d * i_q);
}

template <typename T>
T dq_torque_Nm(const PhaseMotor<T>& m, const T& i_d, const T& i_q) {
  const DqFlux<T> f = dq_flux(m, i_d, i_q);
  return 1.5 * m.pole_pairs * (f.psi_d_Wb * i_q - f.psi_q_Wb * i_d);
}

template <typename T>
struct DqState {
  T i_d_A = T(0), i_q_A = T(0);
  T omega_rotor_rad_s = T(0);
  T theta_rotor_rad = T(0);
  T omega_change_rad_s = T(0);  // over the step before: where the next one begins to look
};

template <typename T>
struct DqInput {
  T v_d_V = T(0), v_q_V = T(0);   // at the winding, mean over the step
  T tau_load_Nm = T(0);           // against positive speed
  T extra_inertia_kg_m2 = T(0);   // that turns with the rotor
  bool speed_is_imposed = false;  // from outside: the speed stays as it is
};

template <typename T>
struct DqStepResult {
  T torque_Nm = T(0);  // means over the step
  T i_d_A = T(0), i_q_A = T(0);
  T omega_rotor_rad_s = T(0);
  T heat_J = T(0);
  T electrical_J = T(0);
  T mechanical_J = T(0);  // given to the rotor: tau omega h
};

template <typename T>
DqStepResult<T> advance_dq(const PhaseMotor<T>& m, DqState<T>& x, const DqInput<T>& in, double h_s) {
  const double two_over_h = 2.0 / h_s, pole_pairs = m.pole_pairs;
  const T inertia = m.rotor_inertia_kg_m2 + in.extra_inertia_kg_m2;
  const T rotor_rate = 0.5 * h_s / inertia;  // h / (2 J)
  T i_d = x.i_d_A, i_q = x.i_q_A, torque = T(0);
  T omega = in.speed_is_imposed ? x.omega_rotor_rad_s : x.omega_rotor_rad_s + 0.5 * x.omega_change_rad_s;
  for (int pass = 0; pass < 2; ++pass) {
    const DqFlux<T> f = dq_flux(m, i_d, i_q);
    const T we = pole_pairs * omega;
    // Flux linearised around the pass before: psi(i) = psi0 + l i.  Unknown: the currents at mid step.
    //   (R + 2/h l_dd - we l_dq) i_d + (2/h l_dq - we l_qq) i_q = v_d + 2/h (l i0)_d + we psi0_q
    //   (2/h l_dq + we l_dd) i_d + (R + 2/h l_qq + we l_dq) i_q = v_q + 2/h (l i0)_q - we psi0_d
    const T psi0_d = f.psi_d_Wb - f.dd_H * i_d - f.dq_H * i_q;
    const T psi0_q = f.psi_q_Wb - f.dq_H * i_d - f.qq_H * i_q;
    const T a = m.resistance_ohm + two_over_h * f.dd_H - we * f.dq_H;
    const T b = two_over_h * f.dq_H - we * f.qq_H;
    const T c = two_over_h * f.dq_H + we * f.dd_H;
    const T d = m.resistance_ohm + two_over_h * f.qq_H + we * f.dq_H;
    const T y_d = in.v_d_V + two_over_h * (f.dd_H * x.i_d_A + f.dq_H * x.i_q_A) + we * psi0_q;
    const T y_q = in.v_q_V + two_over_h * (f.dq_H * x.i_d_A + f.qq_H * x.i_q_A) - we * psi0_d;
    const T scale = 1.0 / (a * d - b * c);
    const T next_d = (d * y_d - b * y_q) * scale, next_q = (a * y_q - c * y_d) * scale;
    // flux at the new currents, to first order: exact where unsaturated
    const T psi_d = psi0_d + f.dd_H * next_d + f.dq_H * next_q;
    const T psi_q = psi0_q + f.dq_H * next_d + f.qq_H * next_q;
    i_d = next_d;
    i_q = next_q;
    torque = 1.5 * pole_pairs * (psi_d * i_q - psi_q * i_d);
    if (in.speed_is_imposed) continue;
    // J (w1 - w0) / h = tau - b w - tau_load at mid step
    omega = (x.omega_rotor_rad_s + rotor_rate * (torque - in.tau_load_Nm)) /
            (1.0 + rotor_rate * m.viscous_friction_Nm_s_per_rad);
  }
  DqStepResult<T> r;
  r.torque_Nm = torque;
  r.i_d_A = i_d;
  r.i_q_A = i_q;
  r.omega_rotor_rad_s = omega;
  r.heat_J = 1.5 * m.resistance_ohm * (i_d * i_d + i_q * i_q) * h_s;
  r.electrical_J = 1.5 * (in.v_d_V * i_d + in.v_q_V * i_q) * h_s;
  r.mechanical_J = torque * omega * h_s;
  x.omega_change_rad_s = 2.0 * (omega - x.omega_rotor_rad_s);
  x.omega_rotor_rad_s += x.omega_change_rad_s;
  x.theta_rotor_rad += h_s * omega;
  x.i_d_A = 2.0 * i_d - x.i_d_A;
  x.i_q_A = 2.0 * i_q - x.i_q_A;
  return r;
}

}  // namespace omnihil
