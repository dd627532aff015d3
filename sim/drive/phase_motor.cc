#include "sim/drive/phase_motor.h"

#include <fmt/format.h>

namespace omnihil {

PhaseMotor<double> phase_motor_of(const MotorParams& motor, Commutation given_for, const BackEmf& shape) {
  PhaseMotor<double> m;
  m.resistance_ohm = 0.5 * motor.resistance_ohm;
  m.inductance_d_H = m.inductance_q_H = 0.5 * motor.inductance_H;
  m.pole_pairs = motor.pole_pairs;
  m.back_emf = shape;
  if (motor.pole_pairs > 0)
    m.flux_linkage_Wb =
        motor.torque_constant_Nm_per_A / (torque_constant_factor(shape, given_for) * motor.pole_pairs);
  m.rotor_inertia_kg_m2 = motor.rotor_inertia_kg_m2;
  m.viscous_friction_Nm_s_per_rad = motor.viscous_friction_Nm_s_per_rad;
  return m;
}

MotorParams dc_equivalent_of(const PhaseMotor<double>& m, Commutation c, const MotorParams& like) {
  MotorParams dc = like;
  dc.resistance_ohm = 2.0 * m.resistance_ohm;
  dc.inductance_H = 2.0 * m.inductance_q_H;
  dc.torque_constant_Nm_per_A = torque_constant_Nm_per_A(m, c);
  dc.rotor_inertia_kg_m2 = m.rotor_inertia_kg_m2;
  dc.viscous_friction_Nm_s_per_rad = m.viscous_friction_Nm_s_per_rad;
  dc.pole_pairs = m.pole_pairs;
  return dc;
}

std::vector<std::string> problems_of(const PhaseMotor<double>& m) {
  std::vector<std::string> problems;
  const auto positive = [&](const char* name, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
      problems.push_back(fmt::format("{} = {}: must be greater than 0", name, value));
  };
  const auto not_negative = [&](const char* name, double value) {
    if (!(value >= 0.0) || !std::isfinite(value))
      problems.push_back(fmt::format("{} = {}: must be 0 or greater", name, value));
  };
  positive("resistance_ohm", m.resistance_ohm);
  positive("inductance_d_H", m.inductance_d_H);
  positive("inductance_q_H", m.inductance_q_H);
  positive("flux_linkage_Wb", m.flux_linkage_Wb);
  positive("rotor_inertia_kg_m2", m.rotor_inertia_kg_m2);
  not_negative("viscous_friction_Nm_s_per_rad", m.viscous_friction_Nm_s_per_rad);
  not_negative("inductance_saturation_per_A", m.inductance_saturation_per_A);
  not_negative("flux_saturation_per_A", m.flux_saturation_per_A);
  if (m.pole_pairs < 1)
    problems.push_back(fmt::format("pole_pairs = {}: a three-phase motor needs 1 or more", m.pole_pairs));
  const double top = m.back_emf.flat_top_rad;
  if (!(top >= 0.0 && top < std::numbers::pi))
    problems.push_back(fmt::format("flat_top_rad = {}: must be 0 or greater and less than pi", top));
  return problems;
}

}  // namespace omnihil
