// What is fixed about one drive, on any scalar: winding, rotor, gear, load, supply, servo. The base model
// that effects act upon.
//
//   DriveParams<double> p = drive_params_of(table);          // axis_model.h: from a model file's rows
//   DriveParams<Jet> q = drive_params_as<Jet>(p);            // then make what is to be fitted an unknown
//
// SI. Rotor side, except where the name says output. A linear axis uses the same fields with kg for kg m^2,
// N for N m and m for rad, and a gear of 1.
#pragma once
#include <span>
#include <string_view>

#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct DriveParams {
  T resistance_ohm = T(0);  // terminal, phase to phase; 0 with drives that are torque controlled
  T inductance_H = T(0);
  T torque_constant_Nm_per_A = T(0);  // equals the back-EMF constant in V s/rad
  T rotor_inertia_kg_m2 = T(0);
  T viscous_friction_Nm_s_per_rad = T(0);
  T coulomb_friction_Nm = T(0);  // of motors whose file carries it; usually the effect coulomb_friction
  T current_limit_A = T(0);      // 0: none
  T duty_limit_ratio = T(1);
  T gear_ratio = T(1);          // rotor turns per output turn
  T load_inertia_kg_m2 = T(0);  // at the output
  T gravity_torque_Nm = T(0);   // m g l at the output; torque = -gravity_torque * sin(position)
  T supply_voltage_V = T(0);
  T servo_kp_duty_per_rad = T(0);
  T servo_duty_limit_ratio = T(1);
  T pwm_frequency_Hz = T(0);  // 0: unknown
  int pole_pairs = 0;         // 0: unknown
  int slots = 0;
  bool linear = false;
};

// J = J_rotor + J_load / N^2, at the rotor
template <typename T>
T inertia_at_rotor(const DriveParams<T>& p) {
  return p.rotor_inertia_kg_m2 + p.load_inertia_kg_m2 / (p.gear_ratio * p.gear_ratio);
}

// The same numbers on another scalar.
template <typename T>
DriveParams<T> drive_params_as(const DriveParams<double>& p) {
  DriveParams<T> q;
  q.resistance_ohm = T(p.resistance_ohm);
  q.inductance_H = T(p.inductance_H);
  q.torque_constant_Nm_per_A = T(p.torque_constant_Nm_per_A);
  q.rotor_inertia_kg_m2 = T(p.rotor_inertia_kg_m2);
  q.viscous_friction_Nm_s_per_rad = T(p.viscous_friction_Nm_s_per_rad);
  q.coulomb_friction_Nm = T(p.coulomb_friction_Nm);
  q.current_limit_A = T(p.current_limit_A);
  q.duty_limit_ratio = T(p.duty_limit_ratio);
  q.gear_ratio = T(p.gear_ratio);
  q.load_inertia_kg_m2 = T(p.load_inertia_kg_m2);
  q.gravity_torque_Nm = T(p.gravity_torque_Nm);
  q.supply_voltage_V = T(p.supply_voltage_V);
  q.servo_kp_duty_per_rad = T(p.servo_kp_duty_per_rad);
  q.servo_duty_limit_ratio = T(p.servo_duty_limit_ratio);
  q.pwm_frequency_Hz = T(p.pwm_frequency_Hz);
  q.pole_pairs = p.pole_pairs;
  q.slots = p.slots;
  q.linear = p.linear;
  return q;
}

// One base parameter that a drive has: its path in a model file and where it is in DriveParams.
struct DriveParamPath {
  std::string_view path;         // "motor.resistance_ohm"
  std::string_view linear_path;  // on a linear axis; "" where it has none
  double DriveParams<double>::*value;
  // The same member on the scalar that carries derivatives.
  Jet DriveParams<Jet>::*jet;
};
std::span<const DriveParamPath> drive_param_paths();

}  // namespace omnihil
