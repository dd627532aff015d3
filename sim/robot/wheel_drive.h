// One wheel's drive and friction through one mechanical step: motor torque, and friction that really holds
// still.
//
//   WheelDriveLaw law = wheel_drive_law(model, electrical_step_s);
//   WheelStep step = begin_wheel_step(law, drive_state, input, contact_Nm, substeps);   // torque to hold
//   ... mechanics advances one step with step.rotor_Nm, step.locked ...
//   omega_wheel = end_wheel_step(law, step, omega_before, omega_after, step_s);         // stops at zero
//
// Law: the winding is advanced exactly over the step's electrical sub-steps (dc_drive.h) with floor and
// friction
//   torque of the step's start held; its mean torque then drives the mechanics.
//   Coulomb friction tau_c acts at the rotor (Karnopp 1985, in event form):
//   turning:  tau_c against the motion; its sign is fixed within a step.
//   at zero:  locked while |motor + floor| <= tau_c: speed and acceleration are exactly zero. Above, it
//   breaks away. a wheel that passes zero within a step: the part of the step past zero runs against friction
//   instead of with it, so the speed gained there shrinks by 1 - 2 tau_c / |net torque|, to exactly zero
//   where friction holds. Friction therefore only ever takes energy. Viscous friction b omega acts
//   continuously in the mechanics.
// The wheel's own freedom is decoupled in the planar mass matrix, so that a lock is exact there.
// Cannot represent: a break-away torque above the turning one (Stribeck), friction that depends on load.
#pragma once
#include "sim/motor/dc_drive.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

struct WheelDriveLaw {
  DcDrive turning;
  DcDrive locked;  // the same winding on a rotor that friction holds
  double coulomb_Nm = 0.0;
  double viscous_Nm_s_per_rad = 0.0;
  double gear_ratio = 1.0;
  double spin_inertia_kg_m2 = 0.0;  // wheel and rotor, at the wheel
};

struct WheelStep {
  double rotor_Nm = 0.0;  // winding and Coulomb friction, held through the step
  bool locked = false;
  double direction = 0.0;  // friction acts against it; 0: none or locked
  DcDriveResult drive;
};

// What the bridge is asked to do and what it hangs on.
struct BridgeInput {
  std::uint32_t mode = OMNIHIL_DRIVE_COAST;
  double duty_ratio = 0.0;
  double bus_voltage_V = 0.0;
};

WheelDriveLaw wheel_drive_law(const RobotModel& model, double electrical_step_s);

// contact_Nm: the floor's torque on the rotor through the gear, positive against positive omega.
WheelStep begin_wheel_step(const WheelDriveLaw& law, DcDriveState& state, const BridgeInput& bridge,
                           double omega_rotor_rad_s, double contact_Nm, int substeps);

// The wheel's speed after the step, with the crossing of zero settled.
double end_wheel_step(const WheelDriveLaw& law, const WheelStep& step, double omega_wheel_before_rad_s,
                      double omega_wheel_after_rad_s, double step_s);

}  // namespace omnihil
