// Rotor and output as two masses with a spring between: what their mode's frequency and loss say of the
// spring.
//
//   TwoMassMode mode{.frequency_Hz = 150.0, .loss = 0.5, .compliance_rad_per_Nm = 0.03, …};
//   mode.compliance_of(drive);   // that rings at 150 Hz; the mode's own where one of the masses is nothing
//
// At the output; both masses against each other, nothing held. Source: Meirovitch, Fundamentals of
// Vibrations, 2001. Limits: one spring, one mode.
#pragma once
#include <numbers>

#include "sim/law/drive_params.h"

namespace omnihil {

// Both masses in parallel, at the output.
inline double reduced_inertia_kg_m2(const DriveParams<double>& drive) {
  const double rotor = drive.rotor_inertia_kg_m2 * drive.gear_ratio * drive.gear_ratio;
  const double sum = rotor + drive.load_inertia_kg_m2;
  return sum > 0.0 ? rotor * drive.load_inertia_kg_m2 / sum : 0.0;
}

struct TwoMassMode {
  double frequency_Hz = 0.0;
  double loss = 0.0;  // of critical damping
  // of a drive whose masses are not known
  double compliance_rad_per_Nm = 0.0;
  double damping_Nm_s_per_rad = 0.0;

  // c = 1 / (J (2 pi f)^2)
  double compliance_of(const DriveParams<double>& drive) const {
    const double inertia = reduced_inertia_kg_m2(drive), rate = 2.0 * std::numbers::pi * frequency_Hz;
    return inertia > 0.0 ? 1.0 / (inertia * rate * rate) : compliance_rad_per_Nm;
  }
  // d = 2 zeta J (2 pi f)
  double damping_of(const DriveParams<double>& drive) const {
    const double inertia = reduced_inertia_kg_m2(drive), rate = 2.0 * std::numbers::pi * frequency_Hz;
    return inertia > 0.0 ? 2.0 * loss * inertia * rate : damping_Nm_s_per_rad;
  }
};

}  // namespace omnihil
