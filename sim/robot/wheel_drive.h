// One wheel's drive and friction through one mechanical step: motor torque, and friction that really holds
// still.
//
//   WheelDriveLaw law = wheel_drive_law(model, electrical_step_s, substeps);
//   WheelStep step = begin_wheel_step(law, drive_state, bridge, omega_rotor_rad_s, contact_Nm);
//   // … mechanics advances one step with step.torque …
//   double omega_wheel_rad_s = end_wheel_step(law, drive_state, step, omega_before_rad_s, omega_after_rad_s);   // stops at zero
//
// Law: the winding is advanced exactly over the step's electrical sub-steps (dc_drive.h) with floor and
//   friction torque of the step's start held. The mechanics gets its torque at start and end and, between,
//   the value that makes the step's mean by Simpson's rule: the current's rise within the step is not lost.
//   The floor's force changes within the step, so the rotor's true speed departs from the predicted one, to
//   first order linearly: d t. The current of a winding at a held voltage departs by L di/dt + R i = -k d t. With
//   x = h R / L over the step h, this departure's
//     mean         -(k/R) phi d h/2,  phi = 1 - 2 (1 - (1 - e^-x) / x) / x:  the mechanics sees its slope, (k^2/R) phi
//     value at h   -(k/R) d h (1 - (1 - e^-x) / x):  corrects the current after the step
//   None while coasting or at the current limit: no voltage is held then.
//   Coulomb friction tau_c acts at the rotor (after Karnopp 1985, in event form):
//     turning  tau_c against the motion; its sign is fixed within a step
//     at zero  locked while |motor + floor| <= tau_c: speed and acceleration exactly zero; above, it breaks away
//   A wheel that passes zero within a step: the part of the step past zero runs against friction instead of with
//   it, so the speed gained there shrinks by 1 - 2 tau_c / |net torque|, to exactly zero where friction holds.
//   Friction therefore only ever takes energy. Viscous friction b omega acts continuously in the mechanics.
// The wheel's own freedom is decoupled in the planar mass matrix, so that a lock is exact there.
// Cannot represent: a break-away torque above the turning one (Stribeck), friction that depends on load.
#pragma once
#include "sim/drive/dc_drive.h"
#include "sim/robot/mechanics.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

struct WheelDriveLaw {
  DcDrive turning;
  DcDrive locked;  // the same winding on a rotor that friction holds
  double coulomb_Nm = 0.0;
  double viscous_Nm_s_per_rad = 0.0;
  double gear_ratio = 1.0;
  double spin_inertia_kg_m2 = 0.0;            // wheel and rotor, at the wheel
  int substeps = 1;                           // electrical, per mechanical step
  double step_s = 0.0;                        // mechanical
  double mean_sensitivity_A_s_per_rad = 0.0;  // (k/R) phi: mean current per mean speed departed
  double end_sensitivity_A_s_per_rad = 0.0;   // current at the step's end per speed departed there
};

struct WheelStep {
  WheelTorque torque;       // for the mechanics
  double direction = 0.0;   // friction acts against it; 0: none or locked
  bool rotor_held = false;  // by friction throughout, where the rotor is a mass of its own
  DcDriveResult drive;
};

// What the bridge is asked to do and what it hangs on.
struct BridgeInput {
  std::uint32_t mode = OMNIHIL_DRIVE_COAST;
  double duty_ratio = 0.0;
  double bus_voltage_V = 0.0;
};

WheelDriveLaw wheel_drive_law(const RobotModel& model, double electrical_step_s, int substeps);

// contact_Nm: the floor's torque on the rotor through the gear, positive against positive omega.
WheelStep begin_wheel_step(const WheelDriveLaw& law, DcDriveState& state, const BridgeInput& bridge,
                           double omega_rotor_rad_s, double contact_Nm);

// The wheel's speed after the step, with the crossing of zero settled; `state` and `step.drive` get the
// winding's response to the departure of that speed from the predicted one.
double end_wheel_step(const WheelDriveLaw& law, DcDriveState& state, WheelStep& step,
                      double omega_wheel_before_rad_s, double omega_wheel_after_rad_s);

}  // namespace omnihil
