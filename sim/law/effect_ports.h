// What an effect may read and change, per place: one struct each. The framework fills a port, calls the
// effects of that place in the order of their ids, and takes the changed fields back.
//
//   template <typename T> static void apply(const T* p, T* x, TorquePort<T>& port) {
//     port.add_friction(p[0]);                // holds still at zero speed, with all others together
//   }
//
// p: the effect's parameters in the order of its rows. x: its states, kept between sub-steps (null: it has
// none). Fields under "reads" are given; fields under "changes" start at the base model's value or at zero.
// Motor side, SI. "mid": value expected at the middle of the sub-step, so that a law is met to second order.
#pragma once
#include <cstdint>

#include "sim/law/command_history.h"

namespace omnihil {

// What a drive is asked for.
enum class CommandKind : std::uint8_t {
  kDuty,            // of the bus voltage
  kMotorVoltage,    // V at the bridge
  kMotorCurrent,    // A, imposed by a current-controlled drive
  kMotorTorque,     // N m at the rotor (N for a linear axis); no electrical part
  kPositionTarget,  // rad at the output; the servo law makes a duty of it
};

template <typename T>
struct CommandPort {
  // reads
  CommandKind kind = CommandKind::kDuty;
  const CommandHistory* history = nullptr;  // what was asked, and when
  double now_s = 0.0;                       // start of the sub-step
  double dt_s = 0.0;
  T position_rad = T(0);  // of the output
  // changes
  T setpoint = T(0);          // of `kind`, mean over the sub-step
  T duty_limit_ratio = T(1);  // duty is held within it afterwards

  // What a law with a memory begins with at its first call: what was asked before; the same as now where nobody knows.
  T asked_before() const { return history != nullptr ? T(history->first_value()) : setpoint; }
};

template <typename T>
struct SupplyPort {
  // reads
  T bus_current_A = T(0);  // that all drives on this supply take together, at the start of the sub-step
  double dt_s = 0.0;
  // changes
  T bus_voltage_V = T(0);  // at the bridge; not called where it is measured
};

template <typename T>
struct BridgePort {
  // reads
  CommandKind kind = CommandKind::kDuty;
  T duty_ratio = T(0);
  T bus_voltage_V = T(0);
  T current_A = T(0);   // at the start of the sub-step; at its end for a law that reads it (kReadsCurrent)
  T back_emf_V = T(0);  // mid, of the base model
  T temperature_rise_K = T(0);  // of the winding; needs = "winding_heating"
  T resistance_ohm = T(0);      // of the winding, as effects left it
  T pwm_frequency_Hz = T(0);    // 0: unknown
  double dt_s = 0.0;
  // changes
  T voltage_V = T(0);                    // mean at the winding
  T inverse_current_limit_per_A = T(0);  // 0: none; only ever raise it
};

template <typename T>
struct WindingPort {
  // reads
  T current_A = T(0);          // at the start of the sub-step
  T omega_rotor_rad_s = T(0);  // mid
  T theta_rotor_rad = T(0);    // mid
  T heat_W = T(0);             // R i^2 of the sub-step before
  int pole_pairs = 0;          // 0: unknown
  int wheel = 0;               // of the robot; 0 on an axis
  double dt_s = 0.0;
  // changes
  T resistance_ohm = T(0);
  T inductance_H = T(0);
  T torque_constant_Nm_per_A = T(0);
  T back_emf_V_s_per_rad = T(0);  // equals the torque constant unless an effect parts them
  T back_emf_offset_V = T(0);     // not proportional to speed
  T temperature_rise_K = T(0);    // over ambient; whoever models it writes it, the others read it
};

template <typename T>
struct TorquePort {
  // reads
  T omega_rotor_rad_s = T(0);  // mid; exactly 0 while held
  T theta_rotor_rad = T(0);    // mid
  // mid: the angle less every correction by a measured one (slaved angle), for laws of a way, not of a place
  T travel_rad = T(0);
  T omega_output_rad_s = T(0);
  T theta_output_rad = T(0);
  T tau_motor_Nm = T(0);  // electromagnetic, mean expected over the sub-step
  T gear_ratio = T(1);
  T inertia_kg_m2 = T(0);  // of all that turns with the rotor
  double dt_s = 0.0;
  // changes
  T tau_Nm = T(0);  // added to the rotor, positive accelerates
  // At the rotor, positive accelerates: starts as the base model's gravity and everything outside, for laws
  // that look at the load. An effect that is a load adds itself here too; only tau_Nm moves anything.
  T tau_load_Nm = T(0);
  T friction_positive_Nm =
      T(0);  // level that opposes motion in the positive direction and holds at zero; >= 0
  T friction_negative_Nm = T(0);
  T viscous_positive_Nm_s_per_rad = T(0);  // solved implicitly, so no step is too long for it
  T viscous_negative_Nm_s_per_rad = T(0);

  void add_friction(const T& level_Nm) {
    friction_positive_Nm += level_Nm;
    friction_negative_Nm += level_Nm;
  }
  void add_viscous(const T& coefficient_Nm_s_per_rad) {
    viscous_positive_Nm_s_per_rad += coefficient_Nm_s_per_rad;
    viscous_negative_Nm_s_per_rad += coefficient_Nm_s_per_rad;
  }
};

// Between rotor and output, referred to the output shaft. The framework solves the two masses.
template <typename T>
struct ShaftPort {
  // reads
  T twist_rad = T(0);  // rotor over gear, minus output
  T twist_rate_rad_s = T(0);
  T gear_ratio = T(1);
  double dt_s = 0.0;
  // changes
  T gap_rad = T(0);                // whole play
  T compliance_rad_per_Nm = T(0);  // 0: rigid
  T damping_Nm_s_per_rad = T(0);   // in contact
};

template <typename T>
struct ContactPort {
  // reads
  int wheel = 0;
  T omega_wheel_rad_s = T(0);
  T theta_wheel_rad = T(0);
  T v_longitudinal_m_s = T(0);  // of the wheel's hub over the floor
  T v_lateral_m_s = T(0);
  T load_N = T(0);
  double dt_s = 0.0;
  // changes
  T wheel_radius_m = T(0);
  T slip_speed_m_s = T(0);        // at full grip; 0: no slip but the base model's
  T grip_coefficient = T(0);      // peak; 0: no limit but the base model's
  T force_longitudinal_N = T(0);  // added, floor on wheel
  T force_lateral_N = T(0);
  T friction_wheel_Nm = T(0);  // level that opposes rolling and holds at zero; >= 0
};

template <typename T>
struct BodyPort {
  // reads
  T v_forward_m_s = T(0), v_left_m_s = T(0), omega_body_rad_s = T(0);  // geometric centre, body frame
  T yaw_rad = T(0);
  T dribbler_rad_s = T(0);
  double dt_s = 0.0;
  // changes
  T mass_kg = T(0);
  T yaw_inertia_kg_m2 = T(0);
  T center_of_mass_x_m = T(0), center_of_mass_y_m = T(0);
  T force_x_N = T(0), force_y_N = T(0), torque_z_Nm = T(0);  // added, body frame
};

// Where a sensor that draws random numbers gets them: a pure function of the three.
struct NoiseKey {
  std::uint64_t seed = 0;
  std::uint64_t stream = 0;
  std::uint64_t sample = 0;
};

// Once per sample and encoder.
template <typename T>
struct SensorPort {
  // reads
  T theta_rotor_rad = T(0);  // true, at the instant of the sample
  T omega_rotor_rad_s = T(0);
  T travel_rad = T(0);       // of the rotor since the sample before, both ways counted
  T counts_per_turn = T(0);  // of the encoder, per turn of its shaft; 0: the rig gives angles
  T encoder_turns_per_rotor_turn = T(1);
  double time_s = 0.0;
  double dt_s = 0.0;                // since the sample before
  const NoiseKey* noise = nullptr;  // null: the expected value is asked for
  // Whether the speed is worked out from the encoder; else a sensor of its own tells it.
  bool speed_is_the_encoders = true;
  // changes, at the rotor
  T encoder_angle_rad = T(0);
  T measured_speed_rad_s = T(0);
  T measured_current_A = T(0);  // of the winding, mean since the sample before
};

enum class Stamped : std::uint8_t { kDriveSensors, kVision };

// Once per sample.
template <typename T>
struct TimingPort {
  // reads
  Stamped what = Stamped::kDriveSensors;
  double time_s = 0.0;
  double dt_s = 0.0;
  const NoiseKey* noise = nullptr;  // null: the expected value is asked for
  // changes
  T age_s = T(0);  // how much older than its stamp the measurement is
};

}  // namespace omnihil
