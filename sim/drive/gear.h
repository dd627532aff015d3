// A gear between rotor and output: ratio, loss by the direction of power, play, twist.
//
//   GearParams<double> g{.ratio = 3, .drive_efficiency = 0.95, .backdrive_efficiency = 0.93};
//   double tau_out = gear_output_Nm(g, tau_rotor_Nm, omega_rotor_rad_s);            // rigid, with loss
//   double tau = shaft_torque_Nm(g, twist_rad, twist_rate_rad_s);                   // at the output, elastic
//   advance_gear(g, masses, state, tau_rotor_Nm, tau_load_Nm, 50e-6);
//
// Law: tau_out = N tau eta_d where the rotor drives (tau omega > 0), N tau / eta_b where it is driven.
//      twist = theta_rotor / N - theta_out;  inside the play |twist| <= gap / 2 no torque; outside
//      tau = k (|twist| - gap / 2) + d |twist|', in the twist's direction, never pulling back.
// Source: Nordin and Gutman 2002, "Controlling mechanical systems with backlash", dead-zone model with
// damping; efficiencies: gear makers' data sheets.
// Method of advance_gear: implicit midpoint on both masses, the contact's linear piece found by trying the
// one of the step before first (at most four tries): second order between contacts, first where a step holds
// a contact's beginning or end; stable for any stiffness. Loss applies to the shaft's torque at the rotor.
// The laws are templates on the scalar. Cannot: stiffness that varies with tooth position, loss that holds at
// rest, several stages.
#pragma once
#include <cmath>

namespace omnihil {

template <typename T>
struct GearParams {
  T ratio = T(1);                 // rotor turns per output turn
  T drive_efficiency = T(1);      // rotor drives the load
  T backdrive_efficiency = T(1);  // load drives the rotor
  T gap_rad = T(0);               // whole play, at the output
  T stiffness_Nm_per_rad = T(0);  // at the output
  T damping_Nm_s_per_rad = T(0);  // at the output, in contact
};

// Torque at the output of a rigid gear whose rotor side gives tau.
template <typename T>
T gear_output_Nm(const GearParams<T>& g, const T& tau_rotor_Nm, const T& omega_rotor_rad_s) {
  const bool drives = tau_rotor_Nm * omega_rotor_rad_s >= 0.0;
  return drives ? T(g.ratio * tau_rotor_Nm * g.drive_efficiency)
                : T(g.ratio * tau_rotor_Nm / g.backdrive_efficiency);
}

// Torque at the rotor that a shaft torque on the output asks for: the inverse of the above.
template <typename T>
T gear_rotor_Nm(const GearParams<T>& g, const T& tau_output_Nm, const T& omega_rotor_rad_s) {
  const bool drives = tau_output_Nm * omega_rotor_rad_s >= 0.0;
  return drives ? T(tau_output_Nm / (g.ratio * g.drive_efficiency))
                : T(tau_output_Nm * g.backdrive_efficiency / g.ratio);
}

template <typename T>
T shaft_torque_Nm(const GearParams<T>& g, const T& twist_rad, const T& twist_rate_rad_s) {
  const T half = 0.5 * g.gap_rad;
  if (twist_rad > half) {
    const T tau = g.stiffness_Nm_per_rad * (twist_rad - half) + g.damping_Nm_s_per_rad * twist_rate_rad_s;
    return tau > 0.0 ? tau : T(0);
  }
  if (twist_rad < -half) {
    const T tau = g.stiffness_Nm_per_rad * (twist_rad + half) + g.damping_Nm_s_per_rad * twist_rate_rad_s;
    return tau < 0.0 ? tau : T(0);
  }
  return T(0);
}

template <typename T>
struct GearMasses {
  T rotor_kg_m2 = T(0);
  T output_kg_m2 = T(0);
};

template <typename T>
struct GearState {
  T omega_rotor_rad_s = T(0), omega_output_rad_s = T(0);
  T theta_rotor_rad = T(0), theta_output_rad = T(0);
  int side = 0;  // of contact in the step before: -1, 0 (in the play), 1
};

// One step with the torques from outside held, both positive where they accelerate. Returns the mean torque
// of the shaft on the output.
template <typename T>
T advance_gear(const GearParams<T>& g, const GearMasses<T>& mass, GearState<T>& s, const T& tau_rotor_Nm,
               const T& tau_output_Nm, double h_s) {
  const T twist = s.theta_rotor_rad / g.ratio - s.theta_output_rad;
  const double half_h = 0.5 * h_s;
  T tau = T(0), rate = T(0);
  int side = s.side;
  for (int attempt = 0; attempt < 4; ++attempt) {
    const double sign = side;
    // rotor side's share of the shaft's torque: 1 / N, with the loss by the direction of power
    const T share = side == 0 ? T(0) : T(gear_rotor_Nm(g, T(sign), s.omega_rotor_rad_s) * sign);
    const T w_r = s.omega_rotor_rad_s + half_h * tau_rotor_Nm / mass.rotor_kg_m2;
    const T w_o = s.omega_output_rad_s + half_h * tau_output_Nm / mass.output_kg_m2;
    const T free_rate = w_r / g.ratio - w_o;
    // tau = k (twist + h/2 rate - side gap/2) + d rate,  rate = free - h/2 (share / (N J_r) + 1 / J_o) tau
    const T give = half_h * (share / (g.ratio * mass.rotor_kg_m2) + 1.0 / mass.output_kg_m2);
    const T slope = g.stiffness_Nm_per_rad * half_h + g.damping_Nm_s_per_rad;
    const T rest = g.stiffness_Nm_per_rad * (twist - 0.5 * sign * g.gap_rad);
    tau = side == 0 ? T(0) : T((rest + slope * free_rate) / (1.0 + slope * give));
    rate = side == 0 ? free_rate : T(free_rate - give * tau);
    const T mid = twist + half_h * rate;
    const int there = mid > 0.5 * g.gap_rad ? 1 : (mid < -0.5 * g.gap_rad ? -1 : 0);
    if (side != 0 && tau * sign < 0.0) tau = T(0), rate = free_rate;  // parts: never pulls
    if (there == side || attempt == 3) {
      s.omega_rotor_rad_s += h_s * (tau_rotor_Nm - share * tau) / mass.rotor_kg_m2;
      s.omega_output_rad_s += h_s * (tau_output_Nm + tau) / mass.output_kg_m2;
      s.theta_rotor_rad += h_s * (w_r - half_h * share * tau / mass.rotor_kg_m2);
      s.theta_output_rad += h_s * (w_o + half_h * tau / mass.output_kg_m2);
      break;
    }
    side = there;
  }
  s.side = side;
  return tau;
}

}  // namespace omnihil
