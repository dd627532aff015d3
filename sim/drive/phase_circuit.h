// Three star-connected windings on a bridge, between two switching instants: solved exactly, rotor included.
//
//   PhaseCircuit circuit = make_phase_circuit(motor, switch_resistance_ohm, 5e-6, 0.0);
//   PhaseState x;
//   PhaseFlow flow;
//   advance_circuit(circuit, x, legs, {.bus_voltage_V = 24, .tau_load_Nm = 0.01}, 5e-6, flow);
//
// Law, over the phases x that conduct (n of them), K_x = p lambda f(theta_elec - x):
//   L di_x/dt = V_x - v_star - K_x omega - (R + R_on) i_x,     v_star = mean of (V_x - K_x omega)
//   J domega/dt = sum K_x i_x - b omega - tau_load
//   a phase that carries no current floats at v_star + K_x omega until a diode of its leg conducts; a diode
//   conducts until its current is exactly zero. Where none conducts, a board's own high resistances
//   decide where v_star is; here the mean of the three phases is half of the bus, as far as the diodes let it.
// With V, K and the speed of mid step held, every current is one exponential of time constant L / (R + R_on)
// and its mean is linear in that speed; so winding and rotor (implicit midpoint) are solved together, in
// closed form. Energy closes to rounding; second order in the step, by K and theta alone. Where a diode's
// current reaches zero the step is parted at that instant (closed form; the speed of mid step is reckoned again
// for the shorter part). A diode's start of conduction is looked for at each step's start.
// Source: Krause et al. (2002), ch. 15; Pillay and Krishnan 1989 for floating phase and star point.
// Cannot: salient rotors (L is the mean of d and q), saturation, mutual coupling that depends on the angle,
// dry friction that holds (bring friction in by tau_load, or impose the speed).
#pragma once
#include <array>

#include "sim/drive/back_emf.h"
#include "sim/drive/inverter.h"

namespace omnihil {

// A length of time with its exponential, for several steps of one length.
struct PhaseStretch {
  double h_s = 0.0;
  double decay = 0.0;       // exp(-h / time constant)
  double mean_decay = 0.0;  // (1 - decay) time constant / h: the exponential's mean over the length
};

// Constant: shared between equal drives. Made again when a temperature changed the winding.
struct PhaseCircuit {
  PhaseStretch step;  // the length whose exponential is kept
  double winding_ohm = 0.0;
  double device_ohm = 0.0;
  double inductance_H = 0.0;
  double time_constant_s = 0.0;
  double conductance_per_ohm = 0.0;  // 1 / (R + R_on)
  double pole_pairs = 0.0;
  double back_emf_V_s_per_rad = 0.0;  // p lambda: peak of one phase
  double inertia_kg_m2 = 0.0;
  double viscous_Nm_s_per_rad = 0.0;
  bool sine = true;              // shape of the back-EMF
  double trapezoid_slope = 0.0;  // of a trapezoid's ramp
};

// K_x = p lambda f(theta_elec - x), V s/rad.
inline std::array<double, 3> phase_constants(const PhaseCircuit& c, double theta_rotor_rad) {
  const double theta_elec_rad = c.pole_pairs * theta_rotor_rad;
  const double k = c.back_emf_V_s_per_rad;
  const std::array<double, 3> f =
      c.sine ? sine_shape(theta_elec_rad) : trapezoid_shape(theta_elec_rad, c.trapezoid_slope);
  return {k * f[0], k * f[1], k * f[2]};
}

struct PhaseState {
  std::array<double, 3> current_A{};  // into the motor; they sum to zero
  double omega_rotor_rad_s = 0.0;
  double theta_rotor_rad = 0.0;
};

struct PhaseInput {
  double bus_voltage_V = 0.0;
  double tau_load_Nm = 0.0;       // against positive speed, held
  bool speed_is_imposed = false;  // by a bench or a multibody model: omega_rotor_rad_s stays as it is
};

// Sums since the flow began. bus_J = winding_heat_J + device_heat_J + mechanical_J + gain of stored_J.
struct PhaseFlow {
  double time_s = 0.0;
  std::array<double, 3> charge_C{};  // integral of each phase's current
  std::array<double, 3> leg_V_s{};   // and of each leg's voltage against the bus's minus
  double square_A2_s = 0.0;          // integral of the sum of the currents' squares
  double bus_charge_C = 0.0;         // taken from the bus; negative: given back
  double bus_J = 0.0;
  double drop_J = 0.0;        // in the diodes' forward voltage
  double mechanical_J = 0.0;  // given to the rotor
  double impulse_Nm_s = 0.0;  // integral of the torque
  double angle_rad = 0.0;
  int events = 0;  // diode currents that reached zero
};

PhaseCircuit make_phase_circuit(const PhaseMotor<double>& motor, double switch_resistance_ohm, double step_s,
                                double extra_inertia_kg_m2);

PhaseStretch stretch_of(const PhaseCircuit& circuit, double h_s);

// So many stretches, one after the other.
void advance_circuit(const PhaseCircuit& circuit, PhaseState& x, const std::array<Leg, 3>& legs,
                     const PhaseInput& input, const PhaseStretch& stretch, PhaseFlow& flow,
                     int stretches = 1);
inline void advance_circuit(const PhaseCircuit& circuit, PhaseState& x, const std::array<Leg, 3>& legs,
                            const PhaseInput& input, double h_s, PhaseFlow& flow) {
  advance_circuit(circuit, x, legs, input, stretch_of(circuit, h_s), flow);
}

inline double winding_heat_J(const PhaseCircuit& c, const PhaseFlow& f) {
  return c.winding_ohm * f.square_A2_s;
}
inline double device_heat_J(const PhaseCircuit& c, const PhaseFlow& f) {
  return c.device_ohm * f.square_A2_s + f.drop_J;
}
inline double stored_J(const PhaseCircuit& c, const PhaseState& x) {
  const auto& i = x.current_A;
  return 0.5 * c.inductance_H * (i[0] * i[0] + i[1] * i[1] + i[2] * i[2]);
}

}  // namespace omnihil
