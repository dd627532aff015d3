// The same motor and bridge averaged over the PWM: one step per period (or any other step), no edges.
//
//   AveragedDrive drive = make_averaged_drive(motor, inverter, 50e-6, 0.0);
//   BridgeCommand legs = block_command(0, 1, 0.4, PwmMode::kComplementary);
//   advance_averaged(drive, x, legs, {.bus_voltage_V = 24}, flow);
//
// Law: each leg is a source at its mean voltage over the period (phase_circuit.h does the rest, floating
// phase and commutation through the diodes included):
//   complementary    d V_bus - s(i) f t_d (V_bus + 2 V_f);  s goes from -1 to 1 within +- half the ripple
//   chopped          on: V_bus or 0;  off: a diode's voltage by the current's direction
// Chopped pairs at low current conduct only for a part of the period (discontinuous current). Then the mean
// voltage follows the back-EMF: with a triangle of current, rise (V_on - E) / L_ll, fall (E - V_off) / L_ll,
//   conducting time  t_c = d T (V_on - V_off) / (E - V_off) < T,    mean current  i = rise d T t_c / (2 T)
// and the pair sees the voltage that keeps this current: E + R_ll i instead of d V_on + (1 - d) V_off.
// Source: Mohan, Undeland, Robbins (2003), sec. 7-3 (discontinuous conduction), ch. 8 (dead time).
// Cannot: ripple and its heat; currents within a period; a dead time longer than a pulse. Good where the
// period is short against L / R.
#pragma once
#include "sim/drive/inverter.h"
#include "sim/drive/phase_circuit.h"

namespace omnihil {

struct AveragedDrive {
  PhaseCircuit circuit;
  Inverter inverter;
  double gap_ratio = 0.0;       // dead time over period
  double ripple_per_V_A = 0.0;  // of a pair, at d (1 - d) = 1: 1 / (L_ll f)
};

AveragedDrive make_averaged_drive(const PhaseMotor<double>& motor, const Inverter& inverter, double step_s,
                                  double extra_inertia_kg_m2);

// One step of drive.circuit.step.h_s.
void advance_averaged(const AveragedDrive& drive, PhaseState& state, const BridgeCommand& command,
                      const PhaseInput& input, PhaseFlow& flow);

// A complementary leg that is high for the share `high`, as the mean source that it is over a period.
LegSource mean_leg(const AveragedDrive& drive, double high, double bus_V, double current_A);

// Peak to peak of the current that a pair of windings of L_ll carries on top of its mean.
inline double ripple_A(double bus_V, double duty_ratio, double inductance_ll_H, double pwm_frequency_Hz) {
  // d (1 - d) V T / L
  return bus_V * duty_ratio * (1.0 - duty_ratio) / (inductance_ll_H * pwm_frequency_Hz);
}

}  // namespace omnihil
