// Motors and small helpers that several motor tests share.
#pragma once
#include <cmath>

#include "sim/drive/dc_drive.h"

namespace omnihil::testing {

// An EC 45 flat 30 W like drive, round numbers, no limits.
inline MotorParams plain_motor() {
  MotorParams m;
  m.resistance_ohm = 1.2;
  m.inductance_H = 0.56e-3;
  m.torque_constant_Nm_per_A = 0.0255;
  m.rotor_inertia_kg_m2 = 92.5e-7;
  return m;
}

inline DcDriveInput duty(double duty_ratio, double bus_voltage_V, double omega_rotor_rad_s = 0.0,
                         double tau_load_Nm = 0.0) {
  return {.mode = OMNIHIL_DRIVE_DUTY,
          .duty_ratio = duty_ratio,
          .bus_voltage_V = bus_voltage_V,
          .omega_rotor_rad_s = omega_rotor_rad_s,
          .tau_load_Nm = tau_load_Nm};
}

inline DcDriveInput coast(double bus_voltage_V, double omega_rotor_rad_s, double tau_load_Nm = 0.0) {
  return {.mode = OMNIHIL_DRIVE_COAST,
          .duty_ratio = 0.0,
          .bus_voltage_V = bus_voltage_V,
          .omega_rotor_rad_s = omega_rotor_rad_s,
          .tau_load_Nm = tau_load_Nm};
}

inline constexpr double kSubstep_s = 50e-6;

// Rotor alone, driven for a time by its own prediction of speed.
struct Spin {
  DcDrive drive;
  DcDriveState state{};
  double omega_rad_s = 0.0;
  double electrical_J = 0.0;
  double heat_J = 0.0;

  DcDriveResult run(DcDriveInput input, int substeps) {
    input.omega_rotor_rad_s = omega_rad_s;
    const DcDriveResult r = advance_drive(drive, state, input, substeps);
    omega_rad_s = r.omega_end_rad_s;
    electrical_J += r.electrical_energy_J;
    heat_J += r.heat_J;
    return r;
  }
};

}  // namespace omnihil::testing
