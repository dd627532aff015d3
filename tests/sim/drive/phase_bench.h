// What the tests of the three-phase drive share: one motor, one bridge, and ways to run them.
#pragma once
#include <cmath>
#include <functional>
#include <numbers>

#include "sim/drive/averaged_drive.h"
#include "sim/drive/dq_motor.h"
#include "sim/drive/hall_sensors.h"
#include "sim/drive/switched_drive.h"

namespace omnihil {

inline constexpr double kDegree = std::numbers::pi / 180.0;

// A 50 W flat motor of a small-size robot (figures of a data sheet, friction a guess).
inline MotorParams sheet_motor() {
  MotorParams m;
  m.resistance_ohm = 0.447;
  m.inductance_H = 0.243e-3;
  m.torque_constant_Nm_per_A = 0.0295;
  m.rotor_inertia_kg_m2 = 135e-7;
  m.viscous_friction_Nm_s_per_rad = 2e-5;
  m.pole_pairs = 8;
  return m;
}

inline constexpr BackEmf kSine{BackEmfShape::kSine, 0.0};
inline constexpr BackEmf kTrapezoid{BackEmfShape::kTrapezoid, 120.0 * kDegree};

inline PhaseMotor<double> trapezoid_motor() {
  return phase_motor_of(sheet_motor(), Commutation::kBlock, kTrapezoid);
}
inline PhaseMotor<double> sine_motor() {
  return phase_motor_of(sheet_motor(), Commutation::kSinusoidal, kSine);
}

inline BridgeCommand six_step(double theta_elec_rad, double duty_ratio, PwmMode mode) {
  const BlockLegs legs = block_legs(hall_sector(hall_code({}, theta_elec_rad)));
  return block_command(legs.high, legs.low, duty_ratio, mode);
}

// Everything that left the bus, minus where it went.
inline double energy_gap_J(const PhaseCircuit& c, const PhaseFlow& f, double stored_gain_J) {
  return f.bus_J - winding_heat_J(c, f) - device_heat_J(c, f) - f.mechanical_J - stored_gain_J;
}

}  // namespace omnihil
