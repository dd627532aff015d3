#include "sim/robot/wheel_drive.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/planar_law.h"

namespace omnihil {
namespace {

// A rotor that does not turn: so heavy that no motor moves it by a rounding error within a run's step.
constexpr double kHeldRotorInertia_kg_m2 = 1e12;

// Torque and predicted speed at the step's start, middle and end, from the winding's currents and their mean.
WheelTorque torque_profile(const WheelDriveLaw& law, const WheelStep& step, double start_A, double end_A,
                           const DcDriveInput& input) {
  const auto& motor = law.turning.constants;
  const double coulomb_Nm = step.direction * law.coulomb_Nm;
  const double mean_Nm = step.drive.mean_torque_Nm - coulomb_Nm;
  const double end_Nm = motor.torque_constant_Nm_per_A * end_A - coulomb_Nm;
  // without inductance the current before the step says nothing: a straight line through mean and end
  const double start_Nm = motor.inductance_H > 0.0 ? motor.torque_constant_Nm_per_A * start_A - coulomb_Nm
                                                   : 2.0 * mean_Nm - end_Nm;
  const double middle_Nm = (6.0 * mean_Nm - start_Nm - end_Nm) / 4.0;  // Simpson's rule
  // first half of the parabola through the three: (5 start + 8 middle - end) / 24
  const double others_Nm = input.tau_load_Nm - coulomb_Nm;
  const double half_Nm = (5.0 * start_Nm + 8.0 * middle_Nm - end_Nm) / 24.0 - 0.5 * others_Nm;
  const double start_rad_s = input.omega_rotor_rad_s;
  WheelTorque profile;
  profile.torque_Nm = {start_Nm, middle_Nm, end_Nm, mean_Nm};
  profile.omega_rad_s = {start_rad_s, start_rad_s + half_Nm * law.step_s / motor.inertia_kg_m2,
                         step.drive.omega_end_rad_s, start_rad_s};
  return profile;
}

double sign_of(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

}  // namespace

WheelDriveLaw wheel_drive_law(const RobotModel& model, double electrical_step_s, int substeps) {
  const MotorParams& motor = model.motor;
  const double gear = model.gear_ratio;
  WheelDriveLaw law;
  law.turning = make_dc_drive(motor, model.wheel_inertia_kg_m2 / (gear * gear), electrical_step_s);
  law.locked = make_dc_drive(motor, kHeldRotorInertia_kg_m2, electrical_step_s);
  law.coulomb_Nm = motor.coulomb_friction_Nm;
  law.viscous_Nm_s_per_rad = motor.viscous_friction_Nm_s_per_rad;
  law.gear_ratio = gear;
  law.spin_inertia_kg_m2 = spin_inertia_kg_m2(model);
  law.substeps = substeps;
  law.step_s = electrical_step_s * substeps;
  // x = h R / L, faded = (1 - e^-x) / x; without inductance x is infinite and the winding responds at once
  const double settled_A_s_per_rad = motor.torque_constant_Nm_per_A / motor.resistance_ohm;
  double mean = 1.0, end = 1.0;
  if (motor.inductance_H > 0.0) {
    const double x = law.step_s * motor.resistance_ohm / motor.inductance_H;
    const double faded = -std::expm1(-x) / x;
    end = 1.0 - faded;
    mean = 1.0 - 2.0 * end / x;
  }
  law.mean_sensitivity_A_s_per_rad = settled_A_s_per_rad * mean;
  law.end_sensitivity_A_s_per_rad = settled_A_s_per_rad * end;
  return law;
}

WheelStep begin_wheel_step(const WheelDriveLaw& law, DcDriveState& state, const BridgeInput& bridge,
                           double omega_rotor_rad_s, double contact_Nm) {
  DcDriveInput input{.mode = bridge.mode,
                     .duty_ratio = bridge.duty_ratio,
                     .bus_voltage_V = bridge.bus_voltage_V,
                     .omega_rotor_rad_s = omega_rotor_rad_s,
                     .tau_load_Nm = 0.0};
  WheelStep step;
  step.direction = sign_of(omega_rotor_rad_s);
  if (step.direction == 0.0 && law.coulomb_Nm > 0.0) {
    DcDriveState trial = state;
    step.drive = advance_drive(law.locked, trial, input, law.substeps);
    const double applied_Nm = step.drive.mean_torque_Nm - contact_Nm;
    if (std::abs(applied_Nm) <= law.coulomb_Nm) {
      state = trial;
      step.torque.locked = true;
      return step;
    }
    step.direction = sign_of(applied_Nm);
  }
  const double coulomb_Nm = step.direction * law.coulomb_Nm;
  const double start_A = state.current_A;
  input.tau_load_Nm = contact_Nm + law.viscous_Nm_s_per_rad * omega_rotor_rad_s + coulomb_Nm;
  step.drive = advance_drive(law.turning, state, input, law.substeps);
  step.torque = torque_profile(law, step, start_A, state.current_A, input);
  const double limit_A = law.turning.current_limit_A;
  const bool voltage_held =
      bridge.mode == OMNIHIL_DRIVE_DUTY && (limit_A == 0.0 || std::abs(state.current_A) < limit_A);
  if (voltage_held) {
    step.torque.slope_Nm_s_per_rad =
        law.turning.constants.torque_constant_Nm_per_A * law.mean_sensitivity_A_s_per_rad;
  }
  return step;
}

double end_wheel_step(const WheelDriveLaw& law, DcDriveState& state, WheelStep& step,
                      double omega_wheel_before_rad_s, double omega_wheel_after_rad_s) {
  if (step.torque.locked) return omega_wheel_after_rad_s;
  if (step.torque.slope_Nm_s_per_rad > 0.0) {
    const double departed_rad_s = law.gear_ratio * omega_wheel_after_rad_s -
                                  step.torque.omega_rad_s[static_cast<std::size_t>(StepPart::kEnd)];
    state.current_A -= law.end_sensitivity_A_s_per_rad * departed_rad_s;
    const double mean_A = -law.mean_sensitivity_A_s_per_rad * 0.5 * departed_rad_s;
    step.drive.mean_current_A += mean_A;
    step.drive.mean_torque_Nm += law.turning.constants.torque_constant_Nm_per_A * mean_A;
  }
  if (law.coulomb_Nm == 0.0 || omega_wheel_after_rad_s * step.direction >= 0.0)
    return omega_wheel_after_rad_s;
  // net torque before zero |net| = |motor + floor| + tau_c; past zero |net| - 2 tau_c, never against the
  // motion
  const double net_Nm = std::abs(omega_wheel_after_rad_s - omega_wheel_before_rad_s) / law.step_s *
                        law.spin_inertia_kg_m2 / law.gear_ratio;
  return omega_wheel_after_rad_s * std::max(0.0, 1.0 - 2.0 * law.coulomb_Nm / net_Nm);
}

}  // namespace omnihil
