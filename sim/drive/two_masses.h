// Rotor and output as two masses with a spring between: what their mode's frequency and loss say of the
// spring.
//
//   double c = mode_compliance_rad_per_Nm(drive, 150.0);         // 0: one of the masses is nothing
//   double d = mode_damping_Nm_s_per_rad(drive, 150.0, 0.5);
//
// At the output; both masses against each other, nothing held. Source: Meirovitch, Fundamentals of
// Vibrations, 2001. Limits: one spring, one mode.
#pragma once
#include <numbers>

#include "sim/drive/drive_params.h"

namespace omnihil {

// Both masses in parallel, at the output.
inline double reduced_inertia_kg_m2(const DriveParams<double>& drive) {
  const double rotor = drive.rotor_inertia_kg_m2 * drive.gear_ratio * drive.gear_ratio;
  const double sum = rotor + drive.load_inertia_kg_m2;
  return sum > 0.0 ? rotor * drive.load_inertia_kg_m2 / sum : 0.0;
}

// c = 1 / (J (2 pi f)^2)
inline double mode_compliance_rad_per_Nm(const DriveParams<double>& drive, double mode_Hz) {
  const double inertia = reduced_inertia_kg_m2(drive), rate = 2.0 * std::numbers::pi * mode_Hz;
  return inertia > 0.0 ? 1.0 / (inertia * rate * rate) : 0.0;
}

// d = 2 zeta J (2 pi f)
inline double mode_damping_Nm_s_per_rad(const DriveParams<double>& drive, double mode_Hz, double loss) {
  return 2.0 * loss * reduced_inertia_kg_m2(drive) * 2.0 * std::numbers::pi * mode_Hz;
}

}  // namespace omnihil
