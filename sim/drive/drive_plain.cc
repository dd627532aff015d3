// The base model without any effect: the same equations as drive_sim.cc with everything computed beforehand.
#include <algorithm>

#include "sim/drive/drive_sim.h"

namespace omnihil {

// The base model's sub-step is linear while its direction and its input last:
//   mean omega = w w0 + i i0 + u u + t (tau - F sgn), and so on
template <typename T>
struct DriveSim<T>::Plain {
  T w, i, constant_positive, constant_negative;  // of mean omega
  T a_w, a_i, a_u;                               // mean current = a_w mean omega + a_i i0 + a_u
  T e_w, e_i, e_u;                               // end current, likewise
};

template <typename T>
bool DriveSim<T>::plain(const DriveInput<T>& input) const {
  return effects_.none_in_drive() && input.enabled && !input.speed_is_imposed &&
         (input.kind == CommandKind::kDuty || input.kind == CommandKind::kMotorVoltage) &&
         is_exactly(params_.gravity_torque_Nm, 0.0) && is_exactly(params_.current_limit_A, 0.0);
}

template <typename T>
DriveResult<T> DriveSim<T>::advance_plain(DriveState<T>& state, const DriveInput<T>& input,
                                          int substeps) const {
  const double h = step_s_;
  DriveResult<T> r;
  r.bus_voltage_V = input.bus_is_measured ? T(input.bus_voltage_V) : params_.supply_voltage_V;
  const T u = input.kind == CommandKind::kDuty
                  ? std::clamp(T(input.setpoint), T(-params_.duty_limit_ratio), params_.duty_limit_ratio) *
                        r.bus_voltage_V
                  : T(input.setpoint);
  const T& k = params_.torque_constant_Nm_per_A;
  const WindingStep<T>& wi = winding_;
  const T scale =
      1.0 / (2.0 * inertia_kg_m2_ + (params_.viscous_friction_Nm_s_per_rad + k * k * wi.gain) * h);
  const T torque = k * wi.gain * u + input.tau_outside_Nm;
  const T& friction = params_.coulomb_friction_Nm;
  const Plain m{.w = 2.0 * inertia_kg_m2_ * scale,
                .i = k * wi.mean_decay * h * scale,
                .constant_positive = (torque - friction) * h * scale,
                .constant_negative = (torque + friction) * h * scale,
                .a_w = -wi.gain * k,
                .a_i = wi.mean_decay,
                .a_u = wi.gain * u,
                .e_w = -(1.0 - wi.decay) * k * wi.conductance_per_ohm,
                .e_i = wi.decay,
                .e_u = (1.0 - wi.decay) * wi.conductance_per_ohm * u};
  const bool dry = value_of(friction) > 0.0;
  T omega = state.omega_rotor_rad_s, current = state.current_A, omega_before = omega;
  T turned = T(0), charge = T(0), work = T(0);
  r.held = true;
  const T omega_first = omega, current_first = current;
  for (int n = 0; n < substeps; ++n) {
    const double w0 = value_of(omega);
    T mean_omega = m.w * omega + m.i * current + (w0 < 0.0 ? m.constant_negative : m.constant_positive);
    T end_omega = 2.0 * mean_omega - omega;
    bool held = false;
    if (dry && (w0 == 0.0 || (w0 > 0.0 ? value_of(end_omega) < 0.0 : value_of(end_omega) > 0.0))) {
      const T damping = params_.viscous_friction_Nm_s_per_rad + k * k * wi.gain;
      const RotorStep<T> stop =
          advance_rotor(omega, h,
                        RotorLoad<T>{inertia_kg_m2_, torque + k * wi.mean_decay * current, damping, damping,
                                     friction, friction});
      mean_omega = stop.mean_omega_rad_s;
      end_omega = stop.omega_end_rad_s;
      held = stop.held;
    }
    const T mean_current = m.a_w * mean_omega + m.a_i * current + m.a_u;
    current = m.e_w * mean_omega + m.e_i * current + m.e_u;
    omega_before = omega;
    omega = end_omega;
    turned += mean_omega;
    charge += mean_current;
    work += mean_omega * mean_current;
    r.held = r.held && held;
  }
  const double count = substeps;
  state.omega_change_rad_s = omega - omega_before;
  state.omega_rotor_rad_s = omega;
  state.current_A = current;
  state.theta_rotor_rad += turned * h;
  state.now_s += h * count;
  r.mean_current_A = charge / count;
  r.mean_voltage_V = u;
  r.electrical_energy_J = u * charge * h;
  r.mean_bus_current_A = value_of(r.bus_voltage_V) > 0.0 ? u * r.mean_current_A / r.bus_voltage_V : T(0);
  r.heat_J = (u * charge - k * work) * h -
             0.5 * wi.inductance_H * (current * current - current_first * current_first);
  state.heat_W = r.heat_J / (h * count);
  r.mean_outside_torque_Nm = input.tau_outside_Nm;
  r.mean_shaft_torque_Nm = inertia_kg_m2_ * (omega - omega_first) / (h * count) - input.tau_outside_Nm;
  return r;
}

template bool DriveSim<double>::plain(const DriveInput<double>&) const;
template bool DriveSim<Jet>::plain(const DriveInput<Jet>&) const;
template DriveResult<double> DriveSim<double>::advance_plain(DriveState<double>&, const DriveInput<double>&,
                                                             int) const;
template DriveResult<Jet> DriveSim<Jet>::advance_plain(DriveState<Jet>&, const DriveInput<Jet>&, int) const;

}  // namespace omnihil
