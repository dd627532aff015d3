#include "sim/robot/wheel_drive.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/planar_law.h"

namespace omnihil {
namespace {

// A rotor that does not turn: so heavy that no motor moves it by a rounding error within a run's step.
constexpr double kHeldRotorInertia_kg_m2 = 1e12;

double sign_of(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

}  // namespace

WheelDriveLaw wheel_drive_law(const RobotModel& model, double electrical_step_s) {
  const double gear = model.gear_ratio;
  return {.turning = make_dc_drive(model.motor, model.wheel_inertia_kg_m2 / (gear * gear), electrical_step_s),
          .locked = make_dc_drive(model.motor, kHeldRotorInertia_kg_m2, electrical_step_s),
          .coulomb_Nm = model.motor.coulomb_friction_Nm,
          .viscous_Nm_s_per_rad = model.motor.viscous_friction_Nm_s_per_rad,
          .gear_ratio = gear,
          .spin_inertia_kg_m2 = spin_inertia_kg_m2(model)};
}

WheelStep begin_wheel_step(const WheelDriveLaw& law, DcDriveState& state, const BridgeInput& bridge,
                           double omega_rotor_rad_s, double contact_Nm, int substeps) {
  DcDriveInput input{.mode = bridge.mode,
                     .duty_ratio = bridge.duty_ratio,
                     .bus_voltage_V = bridge.bus_voltage_V,
                     .omega_rotor_rad_s = omega_rotor_rad_s,
                     .tau_load_Nm = 0.0};
  WheelStep step;
  double direction = sign_of(omega_rotor_rad_s);
  if (direction == 0.0 && law.coulomb_Nm > 0.0) {
    DcDriveState trial = state;
    step.drive = advance_drive(law.locked, trial, input, substeps);
    const double applied_Nm = step.drive.mean_torque_Nm - contact_Nm;
    if (std::abs(applied_Nm) <= law.coulomb_Nm) {
      state = trial;
      step.locked = true;
      return step;
    }
    direction = sign_of(applied_Nm);
  }
  step.direction = direction;
  const double coulomb_Nm = direction * law.coulomb_Nm;
  input.tau_load_Nm = contact_Nm + law.viscous_Nm_s_per_rad * omega_rotor_rad_s + coulomb_Nm;
  step.drive = advance_drive(law.turning, state, input, substeps);
  step.rotor_Nm = step.drive.mean_torque_Nm - coulomb_Nm;
  return step;
}

double end_wheel_step(const WheelDriveLaw& law, const WheelStep& step, double omega_wheel_before_rad_s,
                      double omega_wheel_after_rad_s, double step_s) {
  if (step.locked || law.coulomb_Nm == 0.0) return omega_wheel_after_rad_s;
  if (omega_wheel_after_rad_s * step.direction >= 0.0) return omega_wheel_after_rad_s;
  // net torque before zero |net| = |motor + floor| + tau_c; past zero |net| - 2 tau_c, never against the
  // motion
  const double net_Nm = std::abs(omega_wheel_after_rad_s - omega_wheel_before_rad_s) / step_s *
                        law.spin_inertia_kg_m2 / law.gear_ratio;
  return omega_wheel_after_rad_s * std::max(0.0, 1.0 - 2.0 * law.coulomb_Nm / net_Nm);
}

}  // namespace omnihil
