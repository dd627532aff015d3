// One wheel's winding on its bridge through one period of its drive: the DC-equivalent one, three phases
// averaged, or three phases with every edge. One call shape for all three.
//
//   WheelElectrics wheel(model, electrical_step_s);
//   WheelElectricState x;
//   BridgeCommand legs = wheel.own_command(x, {OMNIHIL_DRIVE_DUTY, 0.4, 24.0}, hall_code);
//   PeriodFlow f = wheel.advance(x, legs, {.bus_voltage_V = 24.0, .tau_load_Nm = 0.01});    // dq, switched
//   PeriodFlow g = wheel.advance_dc(x, {OMNIHIL_DRIVE_DUTY, 0.4, 24.0}, {…});               // dc
//
// Laws: dc_drive.h, dq_motor.h with averaged_drive.h, switched_drive.h. The wheel turns rigidly with the
// rotor; its inertia counts there. dq with all three legs complementary: mean leg voltages (dead time
// included) in the rotor's frame of mid period. With a leg open or chopped: averaged_drive.h.
// own_command: what the bridge's own commutation makes of a duty.
//   dq        U = duty bus,  v_q = U / sqrt(3),  v_d = - omega_e L_q i_q (i_d stays 0), by the angle sensor
//             of now, laid out for mid period; |v| <= bus / sqrt(3), v_d first
//   switched  the Hall sector's pair of legs in the model's PWM mode; no duty: all legs low; no sector
//             (code 0 or 7): all open
//   The current limit of the motor (0: none) bounds U so that the current ends the period within it:
//   U = k omega + R I +- L (I_limit -+ I) / period, in DC-equivalent terms.
// Warm windings: R and k (or the flux linkage) by thermal.h; constants are made again when a temperature has
// moved by more than 0.1 K.
// Cannot: saturation while a leg floats (dq), see also the laws.
#pragma once
#include "sim/drive/averaged_drive.h"
#include "sim/drive/dc_drive.h"
#include "sim/drive/dq_motor.h"
#include "sim/drive/switched_drive.h"
#include "sim/robot/electric_model.h"
#include "sim/robot/wheel_drive.h"

namespace omnihil {

// Plain bytes.
struct WheelElectricState {
  double omega_rotor_rad_s = 0.0, theta_rotor_rad = 0.0;
  double mean_torque_Nm = 0.0;  // of the winding, over the last period
  DcDriveState dc;
  DqState<double> dq;          // currents; motion is that above
  SwitchedState switched;      // likewise
  ThermalState<double> rise;   // now
  ThermalState<double> built;  // with which the constants in use were made
};

struct PeriodInput {
  double bus_voltage_V = 0.0;
  double tau_load_Nm = 0.0;   // against positive speed, without viscous friction
  bool held = false;          // friction keeps the rotor where it is
  double sample_ratio = 0.0;  // three phases: of the period, where the sample is taken
};

struct PeriodFlow {
  double impulse_Nm_s = 0.0;  // of the winding on the rotor
  double angle_rad = 0.0;
  double bus_charge_C = 0.0;
  double winding_heat_J = 0.0, device_heat_J = 0.0, mechanical_J = 0.0;
  std::array<double, kLegs> leg_V{};  // three phases: mean of each leg's voltage against the bus's minus
  PeriodSample sample;                // three phases: at the input's sampling instant
};

class WheelElectrics {
 public:
  WheelElectrics(const RobotModel& model, double electrical_step_s);

  double period_s() const { return period_s_; }
  double inertia_kg_m2() const { return inertia_kg_m2_; }  // rotor and wheel, at the rotor
  double torque_constant_Nm_per_A() const { return torque_constant_Nm_per_A_; }  // cold, as driven

  BridgeCommand own_command(const WheelElectricState& x, const BridgeInput& bridge, int hall_code) const;
  // Legs as a firmware set them; open for a period where a phase carries more than the bridge's limit.
  BridgeCommand firmware_command(const WheelElectricState& x, const MotorDrive& legs,
                                 std::size_t wheel) const;
  PeriodFlow advance(WheelElectricState& x, const BridgeCommand& legs, const PeriodInput& in) const;
  PeriodFlow advance_dc(WheelElectricState& x, const BridgeInput& bridge, const PeriodInput& in) const;

  double torque_Nm(const WheelElectricState& x) const;  // of this instant's currents
  std::array<double, 3> phase_current_A(const WheelElectricState& x) const;
  double stored_J(const WheelElectricState& x) const;  // in the inductances
  double sensed_theta_elec_rad(double theta_rotor_rad, double omega_rotor_rad_s) const;

  // After warming or restoring: brings the constants to x.built, or x.built to x.rise if that moved away.
  void keep_warm(WheelElectricState& x);

 private:
  void make(const ThermalState<double>& rise);
  double limited_voltage_V(const WheelElectricState& x, double wanted_V, double bus_V) const;
  PeriodFlow advance_dq_legs(WheelElectricState& x, const BridgeCommand& legs, const PeriodInput& in) const;
  PeriodFlow advance_averaged_legs(WheelElectricState& x, const BridgeCommand& legs,
                                   const PeriodInput& in) const;

  RobotModel model_;
  ElectricModel electric_;
  double period_s_ = 0.0, inertia_kg_m2_ = 0.0, extra_inertia_kg_m2_ = 0.0, torque_constant_Nm_per_A_ = 0.0;
  ThermalState<double> made_for_;
  double warm_constant_Nm_per_A_ = 0.0;  // and these four by temperature
  PhaseMotor<double> motor_;             // dq: switches' resistance included
  AveragedDrive averaged_;
  SwitchedDrive switched_;
  DcDrive dc_, dc_held_;
};

}  // namespace omnihil
