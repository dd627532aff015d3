// Motor on a switching bridge, one PWM period after the other, exact between switching instants.
//
//   SwitchedDrive drive = make_switched_drive(motor, inverter, {.max_step_s = 5e-6});
//   SwitchedState x;
//   PhaseFlow flow;
//   PeriodSample s = advance_period(drive, x, block_command(0, 1, 0.4, PwmMode::kComplementary),
//                                   {.bus_voltage_V = 24}, 0.5, flow);      // s: currents at mid on-time
//
// The period begins and ends in the middle of the legs' off-time. Every edge, dead time's end, the sampling
// instant, and every diode current's arrival at zero is a boundary of the solution; in between currents are
// exponentials (phase_circuit.h), parted into pieces of at most max_step_s because angle and speed move.
// Cannot: see inverter.h and phase_circuit.h. The bus voltage is held over the call.
#pragma once
#include <array>

#include "sim/drive/inverter.h"
#include "sim/drive/phase_circuit.h"

namespace omnihil {

struct SwitchedOptions {
  double max_step_s = 5e-6;
  double extra_inertia_kg_m2 = 0.0;  // that turns with the rotor
};

struct SwitchedDrive {
  PhaseCircuit circuit;
  Inverter inverter;
  double period_s = 0.0;
  double max_step_s = 0.0;
};

struct SwitchedState {
  PhaseState motor;
  std::array<LegState, 3> wanted{};   // by the command, at the last instant
  std::array<double, 3> blocked_s{};  // dead time still to run
};

// What the legs and windings were at the sampling instant.
struct PeriodSample {
  std::array<double, 3> current_A{};
  std::array<LegState, 3> leg{};
  double theta_rotor_rad = 0.0;
  double omega_rotor_rad_s = 0.0;
};

// A piece between two boundaries, told to whoever listens: at `time_s` of the period the legs are these.
struct SwitchingListener {
  virtual ~SwitchingListener() = default;
  virtual void piece(double time_s, const std::array<LegState, 3>& legs, const PhaseState& before) = 0;
};

SwitchedDrive make_switched_drive(const PhaseMotor<double>& motor, const Inverter& inverter,
                                  const SwitchedOptions& options);

// `sample_ratio`: instant of the sample within the period, 0 to 1 (0.5: middle of the on-time).
PeriodSample advance_period(const SwitchedDrive& drive, SwitchedState& state, const BridgeCommand& command,
                            const PhaseInput& input, double sample_ratio, PhaseFlow& flow,
                            SwitchingListener* listener = nullptr);

}  // namespace omnihil
