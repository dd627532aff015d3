// A three-phase permanent-magnet motor in star: what is fixed about it, and how it relates to the
// DC-equivalent one of the data sheet.
//
//   PhaseMotor<double> m = phase_motor_of(motor_params, Commutation::kBlock,
//                                         {.shape = BackEmfShape::kTrapezoid, …});
//   double k = torque_constant_Nm_per_A(m, Commutation::kSinusoidal);    // of the same motor under FOC
//
// theta_elec is the angle of the rotor's d axis before phase a: theta_elec = pole_pairs * theta_rotor.
// Phase x (a, b, c at 0, 120, 240 degrees) links the flux  lambda cos(theta_elec - x)  and induces
//   e_x = pole_pairs * lambda * omega_rotor * f(theta_elec - x),    f = -sin, or a trapezoid of the same sign
// so lambda is the peak of a phase's back-EMF over the electrical speed, whatever the shape.
//
// Terminal values (phase to phase): R_ll = 2 R, L_ll = 2 L. Torque constant and voltage of the equivalent DC
// motor (same copper loss R_ll I^2, same torque k I, same power U I):
//   sinusoidal, i_d = 0:  k = sqrt(3) p lambda,       I = (sqrt(3) / 2) i_q,   U = sqrt(3) v_q   (exact)
//   block, two phases carry I:  k = 2 p lambda mean of |f| over the 120 degrees that a phase conducts:
//                         sine: (3 sqrt(3) / pi) p lambda,   trapezoid with a top of 120 degrees: 2 p lambda
// Source: Krause, Wasynczuk, Sudhoff, "Analysis of Electric Machinery" (2002), ch. 15; Maxon, "Maxon EC
// motor" for k under block commutation; the equivalence follows from 3/2 R i_q^2 = 2 R I^2. Saturation:
// differential inductance per axis L / (1 + (s_L i)^2), flux linkage lambda / (1 + (s_m i_q)^2); both exactly
// absent at 0. The flux law is that of the effect `saturation`; the shape of L is the simplest with a
// closed-form energy, to be fitted. Cannot: slot harmonics of the back-EMF, unequal phases, delta winding
// (give its star equivalent), iron loss.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "sim/drive/motor_params.h"

namespace omnihil {

enum class BackEmfShape : std::uint8_t { kSine, kTrapezoid };
enum class Commutation : std::uint8_t { kSinusoidal, kBlock };

struct BackEmf {
  BackEmfShape shape = BackEmfShape::kSine;
  double flat_top_rad = 2.0 * std::numbers::pi / 3.0;  // of a trapezoid, electrical, each half wave; 0 .. pi
};

template <typename T>
struct PhaseMotor {
  T resistance_ohm = T(0);  // phase to star
  T inductance_d_H = T(0);  // phase to star, mutual inductance included
  T inductance_q_H = T(0);
  T flux_linkage_Wb = T(0);  // lambda
  T rotor_inertia_kg_m2 = T(0);
  T viscous_friction_Nm_s_per_rad = T(0);
  T inductance_saturation_per_A = T(0);  // s_L
  T flux_saturation_per_A = T(0);        // s_m
  int pole_pairs = 0;
  BackEmf back_emf;
};

// Mean of |f| over the 120 electrical degrees in the middle of a half wave.
inline double mean_block_back_emf(const BackEmf& e) {
  constexpr double kPi = std::numbers::pi;
  if (e.shape == BackEmfShape::kSine) return 1.5 * std::numbers::sqrt3 / kPi;
  const double ramp_rad = 0.5 * (kPi - e.flat_top_rad), window_rad = 2.0 * kPi / 3.0;
  const double cut_rad = ramp_rad - kPi / 6.0;  // of the ramp, inside the window, on either side
  return cut_rad <= 0.0 ? 1.0 : 1.0 - cut_rad * cut_rad / (ramp_rad * window_rad);
}

// k / (p lambda)
inline double torque_constant_factor(const BackEmf& e, Commutation c) {
  return c == Commutation::kSinusoidal ? std::numbers::sqrt3 : 2.0 * mean_block_back_emf(e);
}

template <typename T>
T torque_constant_Nm_per_A(const PhaseMotor<T>& m, Commutation c) {
  return torque_constant_factor(m.back_emf, c) * m.pole_pairs * m.flux_linkage_Wb;
}

// From terminal values. `given_for` says which commutation the torque constant was stated for: block with
// most data sheets.
PhaseMotor<double> phase_motor_of(const MotorParams& motor, Commutation given_for, const BackEmf& shape);

// The DC-equivalent of a motor under this commutation (L_ll from the q axis). Name, friction and limits of
// `like` are kept.
MotorParams dc_equivalent_of(const PhaseMotor<double>& m, Commutation c, const MotorParams& like);

// Everything that is wrong with it, one sentence each, with name, value and what is allowed.
std::vector<std::string> problems_of(const PhaseMotor<double>& m);

}  // namespace omnihil
