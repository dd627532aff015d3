// One drive with any set of effects, advanced by electrical sub-steps: command, supply, bridge, winding,
// torque, shaft, in this order in every sub-step.
//
//   DriveSim<double> sim(params, effects, 50e-6);
//   DriveState<double> state = sim.initial_state();
//   DriveInput<double> in{.kind = CommandKind::kDuty, .setpoint = 0.5, .bus_voltage_V = 24};
//   DriveResult<double> r = sim.advance(state, in, 20);           // 20 sub-steps of 50 us
//
// Base model: L di/dt = u - R i - k omega; J domega/dt = k i - b omega - c sgn(omega) + tau_outside, c really
// holding; J = J_rotor + J_load / N^2; gravity -m g l sin(theta_out) / N. Winding exact per sub-step
// (winding_step.h), rotor implicit midpoint (rotor_step.h), both solved together: second order in the
// sub-step, and electrical energy = heat + magnetic + mechanical to rounding. Effects see speed and angle of
// the sub-step's middle (extrapolated), so smooth laws keep second order; effects with states say their own
// order. Enable off: all switches open, the current dies into the bus through the diodes and stays zero.
// With an effect on the shaft, rotor and output are two masses (shaft_step.h); outside torque and gravity act
// on the output, friction and the torque effects on the rotor, and an imposed speed is the output's.
// Cannot: PWM ripple (averaged voltage), commutation, more than one supply.
//
// With no effect the same equations run with everything precomputed. To a multibody model: write its speed
// and angle, hold its torque over a call, and take mean_shaft_torque_Nm (advance_held below).
#pragma once
#include <array>
#include <cstdint>

#include "sim/drive/rotor_step.h"
#include "sim/drive/winding_step.h"
#include "sim/law/drive_params.h"
#include "sim/law/effect_set.h"

namespace omnihil {

template <typename T>
struct DriveMotion {
  double now_s = 0.0;
  T current_A = T(0);
  T omega_rotor_rad_s = T(0);
  T theta_rotor_rad = T(0);
  T corrected_rad = T(0);  // of theta_rotor_rad: by a measured angle, not turned
  // Of their own only where an effect acts on the shaft; they start where the rotor is.
  T theta_output_rad = T(0);
  T omega_output_rad_s = T(0);
  bool has_output = false;
  T omega_change_rad_s = T(0);  // over the sub-step before, to look ahead to the next one's middle
  T heat_W = T(0);              // R i^2 of the sub-step before
  T temperature_rise_K = T(0);  // of the winding over ambient; stays zero unless an effect models it
  std::array<T, kMaxEffectStates> effects{};
};

template <typename T>
struct DriveState : DriveMotion<T> {
  CommandHistory commands;
};

template <typename T>
struct DriveInput {
  CommandKind kind = CommandKind::kDuty;
  bool enabled = true;
  T setpoint = T(0);             // held over the call
  double bus_voltage_V = 0.0;    // used when bus_is_measured
  bool bus_is_measured = false;  // at the bridge: then nothing sags it again; else the model's supply voltage
  T other_bus_current_A = T(0);  // of other drives on the same supply
  T tau_outside_Nm = T(0);       // at the rotor, positive accelerates; held over the call
  int wheel = 0;
  // The bench turns the shaft: speed of the rotor at the call's start and end, linear between. The torque
  // that this takes comes back as mean_outside_torque_Nm. Where rotor and output are two masses it turns the output (speeds
  // over the gear), or where so said the rotor, and the output follows.
  bool speed_is_imposed = false, rotor_is_imposed = false;
  double imposed_start_rad_s = 0.0, imposed_end_rad_s = 0.0;
  // With an imposed speed: torque effects see the motor torque that the motion needs in place of the one that
  // the setpoint makes (needed_torque.h), for whoever compares the two. Not where rotor and output are two
  // masses.
  bool motor_torque_is_needed = false;
};

template <typename T>
struct DriveResult {
  T mean_current_A = T(0);
  T mean_bus_current_A = T(0);
  T mean_voltage_V = T(0);          // at the winding
  T bus_voltage_V = T(0);           // at the end
  T mean_shaft_torque_Nm = T(0);    // of all inside the drive (friction that holds included) on the inertia
  T mean_outside_torque_Nm = T(0);  // what tau_outside was, or must have been where the speed is imposed
  T heat_J = T(0);                  // in the winding
  T electrical_energy_J = T(0);     // u i, given to the winding
  bool held = false;                // friction held the rotor still throughout
};

template <typename T>
class DriveSim {
 public:
  DriveSim(const DriveParams<T>& params, EffectSet<T> effects, double step_s);

  DriveState<T> initial_state() const;
  void restart(
      DriveState<T>& state) const;  // becomes the initial state; 32 kB of commands only if there were any
  void set_step(double step_s);     // for records whose samples are not evenly spaced
  DriveResult<T> advance(DriveState<T>& state, const DriveInput<T>& input, int substeps) const;

  const DriveParams<T>& params() const { return params_; }
  const EffectSet<T>& effects() const { return effects_; }
  double step_s() const { return step_s_; }
  T inertia_kg_m2() const { return inertia_kg_m2_; }
  // An effect acts on the shaft, and there is a mass on either side of it.
  bool two_masses() const { return two_masses_; }

 private:
  struct Call;   // what stays the same over a call
  struct Step;   // of one sub-step: what is known of it so far
  struct Plain;  // the base model's sub-step as one linear map
  DriveResult<T> advance_plain(DriveState<T>& state, const DriveInput<T>& input, int substeps) const;
  void step(DriveState<T>& state, const DriveInput<T>& input, const Call& call, Step& s,
            DriveResult<T>& sums) const;
  void command(DriveState<T>& state, const DriveInput<T>& input, const Call& call, Step& s) const;
  void supply(DriveState<T>& state, const DriveInput<T>& input, const Call& call, Step& s) const;
  void winding(DriveState<T>& state, const DriveInput<T>& input, Step& s) const;
  void bridge(DriveState<T>& state, const DriveInput<T>& input, const Call& call, Step& s) const;
  void release(const DriveState<T>& state, Step& s) const;
  void torque(DriveState<T>& state, const DriveInput<T>& input, Step& s) const;
  T inverse_torque(const DriveState<T>& state, double start_rad_s, double end_rad_s, T tau_outside_Nm,
                   TorquePort<T> port) const;
  void solve(const DriveState<T>& state, const DriveInput<T>& input, Step& s) const;
  void limit_current(const DriveState<T>& state, Step& s) const;
  void hold_current(const DriveState<T>& state, const T& end_current_A, const T& mean_current_A,
                    Step& s) const;
  void turn(const DriveState<T>& state, Step& s) const;
  void join_shaft(DriveState<T>& state, const DriveInput<T>& input, Step& s) const;
  void turn_output(DriveState<T>& state, const DriveInput<T>& input, Step& s) const;
  bool plain(const DriveInput<T>& input) const;

  DriveParams<T> params_;
  EffectSet<T> effects_;
  double step_s_ = 0.0;
  T inertia_kg_m2_ = T(0);
  T inverse_gear_ = T(1);
  bool two_masses_ = false;
  WindingStep<T> winding_;  // of the base model
  T inductance_over_step_ = T(0), step_over_inductance_ = T(0);
  T base_inverse_limit_per_A_ = T(0);
};

}  // namespace omnihil
