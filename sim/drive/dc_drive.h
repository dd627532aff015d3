// One wheel's drive: bridge, winding and rotor, advanced by whole electrical sub-steps.
//
//   DcDrive drive = make_dc_drive(motor, wheel_inertia_kg_m2 / (gear * gear), 50e-6);
//   DcDriveState state;
//   DcDriveInput input{.mode = OMNIHIL_DRIVE_DUTY, .duty_ratio = 0.5, .bus_voltage_V = 24,
//                      .omega_rotor_rad_s = omega_rotor_rad_s, .tau_load_Nm = friction_Nm + contact_Nm};
//   DcDriveResult r = advance_drive(drive, state, input, 20);     // 1 ms; r.mean_torque_Nm to the plant
//
// Law: dc_law.h (eq. 7 with its speed factor, plus inductance and rotor), solved exactly per sub-step
// (dc_step.h) with voltage and load held. The bridge is averaged over its PWM period: u = duty * bus.
//   duty   u = clamp(duty, +-duty_limit_ratio) * bus; the supply gives and takes u * i.
//   coast  all switches off: the current flows on through the diodes against the bus (u = -sign(i) bus) until
//          it is exactly zero, and stays zero while |k omega| <= bus; above, the diodes rectify into the bus.
//          Approximated: diodes without drop, one winding (a three-phase rectifier conducts in turns);
//          conduction begins at the next sub-step's start.
//   current_limit_A  a chopper that turns the bridge down as soon as the current reaches the limit and holds
//          it there, u = R i + k omega, for as long as the duty asks for more. Looked at once per sub-step:
//          at every sub-step's end |i| <= limit holds exactly; in between only a peak shorter than a sub-step
//          could pass it. Where R i + k omega exceeds the bus (driven faster than the bus can oppose) no
//          chopper can hold the current and the diodes' current flows.
// Friction belongs to the plant and comes in through tau_load; the friction of MotorParams is not used here.
#pragma once
#include <array>
#include <cstdint>

#include "firmware_iface/robot_io.h"
#include "sim/drive/dc_law.h"
#include "sim/drive/dc_step.h"
#include "sim/drive/motor_params.h"

namespace omnihil {

inline constexpr int kLongerSteps = 6;  // 1, 2, 4 … 32 sub-steps at once
inline constexpr int kShorterSteps =
    16;  // 1/2 … 1/65536 of a sub-step, to find where a current reaches a bound

// Constant: share one between equal drives.
struct DcDrive {
  double step_s = 0.0;
  double current_limit_A = 0.0;  // 0: none
  double duty_limit_ratio = 1.0;
  DcDriveConstants<double> constants{};
  std::array<DcStep, kLongerSteps> longer{};    // [n]: 2^n sub-steps
  std::array<DcStep, kShorterSteps> shorter{};  // [n]: 2^-(n+1) of a sub-step
};

struct DcDriveState {
  double current_A = 0.0;
};

struct DcDriveInput {
  std::uint32_t mode = OMNIHIL_DRIVE_COAST;  // OMNIHIL_DRIVE_*
  double duty_ratio = 0.0;
  double bus_voltage_V = 0.0;
  double omega_rotor_rad_s = 0.0;
  double tau_load_Nm =
      0.0;  // held over the call: every torque on the rotor but the winding's, against omega > 0
};

struct DcDriveResult {
  double mean_torque_Nm = 0.0;  // of the winding on the rotor
  double mean_current_A = 0.0;
  double mean_bus_current_A = 0.0;   // taken from the supply; negative: given back
  double heat_J = 0.0;               // R i^2 over the call
  double electrical_energy_J = 0.0;  // u i over the call: taken from the supply
  double omega_end_rad_s = 0.0;      // predicted with the load held
  double angle_rad = 0.0;            // turned during the call, predicted likewise
};

// The inertia that turns with the rotor besides it: wheel (and, if rigidly coupled, robot) over gear^2.
// Throws std::invalid_argument for a resistance, torque constant, inertia or step that is not positive, or a
// negative inductance: model files are checked before, so this is a caller's mistake.
DcDrive make_dc_drive(const MotorParams& motor, double extra_inertia_rotor_side_kg_m2, double step_s);

DcDriveResult advance_drive(const DcDrive& drive, DcDriveState& state, const DcDriveInput& input,
                            int substeps);

}  // namespace omnihil
