// The continuous law of one drive, on any scalar type: with double it is the reference that the exact
// discretisation (dc_step.h) is tested against, with a dual number it gives derivatives to a fit.
//
//   auto rates = dc_drive_rates<double>({.resistance_ohm = 1.2, …}, {.current_A = 0, .omega_rotor_rad_s = 0},
//                                       {.voltage_V = 12, .tau_load_Nm = 0});
//
// Law:  L di/dt = u - R i - k omega,   J domega/dt = k i - tau_load        (k: torque and back-EMF constant)
//       L = 0: i = (u - k omega) / R, hence tau = (k/R) u - (k/(R k')) omega with k' = 1/k, the speed constant
// Source: A robot simulator paper's eq. (7), "tau = (k/R) u - k/(R k')", completed by the speed factor that
// the print lost; winding and rotor: any text on permanent-magnet motors (e.g. Maxon, "Key information").
// Cannot represent: commutation ripple, saturation, iron loss, temperature, PWM ripple (averaged voltage).
#pragma once

namespace omnihil {

template <typename T>
struct DcDriveConstants {
  T resistance_ohm;
  T inductance_H;  // exactly 0: the current follows the voltage at once
  T torque_constant_Nm_per_A;
  T inertia_kg_m2;  // rotor and all that turns with it, at the rotor
};

template <typename T>
struct DcDriveContinuousState {
  T current_A;
  T omega_rotor_rad_s;
};

template <typename T>
struct DcDriveContinuousInput {
  T voltage_V;    // mean at the winding
  T tau_load_Nm;  // every torque on the rotor shaft other than the winding's, positive against positive omega
};

template <typename T>
struct DcDriveRates {
  T current_A_per_s;
  T omega_rotor_rad_s2;
  T torque_Nm;  // of the winding, on the rotor
};

// Eq. (7) with the speed factor: the torque once the current has settled.
template <typename T>
T settled_torque_Nm(const DcDriveConstants<T>& p, const T& voltage_V, const T& omega_rotor_rad_s) {
  // tau = (k/R) u - (k/(R k')) omega,  k' = 1/k
  return p.torque_constant_Nm_per_A / p.resistance_ohm *
         (voltage_V - p.torque_constant_Nm_per_A * omega_rotor_rad_s);
}

template <typename T>
DcDriveRates<T> dc_drive_rates(const DcDriveConstants<T>& p, const DcDriveContinuousState<T>& x,
                               const DcDriveContinuousInput<T>& in) {
  DcDriveRates<T> r{T(0), T(0), T(0)};
  if (p.inductance_H == T(0)) {
    r.torque_Nm = settled_torque_Nm(p, in.voltage_V, x.omega_rotor_rad_s);
  } else {
    // L di/dt = u - R i - k omega
    r.current_A_per_s =
        (in.voltage_V - p.resistance_ohm * x.current_A - p.torque_constant_Nm_per_A * x.omega_rotor_rad_s) /
        p.inductance_H;
    r.torque_Nm = p.torque_constant_Nm_per_A * x.current_A;
  }
  // J domega/dt = tau - tau_load
  r.omega_rotor_rad_s2 = (r.torque_Nm - in.tau_load_Nm) / p.inertia_kg_m2;
  return r;
}

}  // namespace omnihil
