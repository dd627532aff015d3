#include "sim/drive/drive_sim.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace omnihil {
namespace {

template <typename T>
T clamped(const T& x, const T& limit) {
  return x > limit ? limit : (x < -limit ? -limit : x);
}

}  // namespace

template <typename T>
struct DriveSim<T>::Step {
  bool imposed = false;
  T omega_start = T(0), omega_mid = T(0), theta_mid = T(0);
  T imposed_end = T(0);
  T asked = T(0);  // duty, V, A or N m
  T duty_limit = T(1);
  T bus_voltage = T(0);
  bool electric = false;  // winding is solved together with the rotor
  bool open = false;      // switches off, no current
  T voltage = T(0);
  T inverse_limit = T(0);
  WindingStep<T> winding;
  T k = T(0), k_emf = T(0), emf_offset = T(0);
  T current = T(0);         // imposed or held mean current where not electric
  T applied_torque = T(0);  // motor_torque drives
  RotorLoad<T> load{};      // without the winding's part
  T tau_outside = T(0);
  T mean_omega = T(0), omega_end = T(0), mean_current = T(0), end_current = T(0), outside = T(0);
  bool held = false;
};

template <typename T>
DriveSim<T>::DriveSim(const DriveParams<T>& params, EffectSet<T> effects, double step_s)
    : params_(params), effects_(std::move(effects)), step_s_(step_s) {
  inertia_kg_m2_ = inertia_at_rotor(params_);
  inverse_gear_ = 1.0 / params_.gear_ratio;
  assert(value_of(inertia_kg_m2_) > 0.0);
  set_step(step_s);
}

template <typename T>
void DriveSim<T>::set_step(double step_s) {
  assert(step_s > 0.0);
  step_s_ = step_s;
  if (value_of(params_.resistance_ohm) > 0.0) {
    winding_ = make_winding_step(params_.resistance_ohm, params_.inductance_H, step_s);
  }
}

template <typename T>
DriveState<T> DriveSim<T>::initial_state() const {
  DriveState<T> state;
  std::copy(effects_.initial_states().begin(), effects_.initial_states().end(), state.effects.begin());
  return state;
}

// ---------------------------------------------------------------------------------------- the places, in
// order

template <typename T>
void DriveSim<T>::command(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  CommandPort<T> port;
  port.kind = input.kind;
  port.setpoint = T(input.setpoint);
  port.duty_limit_ratio = params_.duty_limit_ratio;
  if (!effects_.command.empty()) {
    port.history = &state.commands;
    port.now_s = state.now_s;
    port.dt_s = step_s_;
    port.position_rad = s.theta_mid * inverse_gear_;
    effects_.command.apply(effects_.values(), state.effects.data(), port);
  }
  s.asked = port.setpoint;
  s.duty_limit = port.duty_limit_ratio;
  if (input.kind == CommandKind::kPositionTarget) {
    // duty = kp (target - position), held within the servo's limit
    const T duty = params_.servo_kp_duty_per_rad * (port.setpoint - s.theta_mid * inverse_gear_);
    s.asked = clamped(duty, params_.servo_duty_limit_ratio);
  }
  if (input.kind == CommandKind::kDuty || input.kind == CommandKind::kPositionTarget) {
    s.asked = clamped(s.asked, s.duty_limit);
  }
}

template <typename T>
void DriveSim<T>::supply(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  s.bus_voltage = input.bus_is_measured ? T(input.bus_voltage_V) : params_.supply_voltage_V;
  if (input.bus_is_measured || effects_.supply.empty()) return;
  SupplyPort<T> port;
  const T duty = input.kind == CommandKind::kMotorVoltage ? s.asked / s.bus_voltage : s.asked;
  port.bus_current_A = input.other_bus_current_A + (input.enabled ? duty * state.current_A : T(0));
  port.dt_s = step_s_;
  port.bus_voltage_V = s.bus_voltage;
  effects_.supply.apply(effects_.values(), state.effects.data(), port);
  s.bus_voltage = port.bus_voltage_V;
}

// Before the bridge, because the bridge looks at the back-EMF; the bridge changes nothing the winding reads.
template <typename T>
void DriveSim<T>::winding(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  s.k = s.k_emf = params_.torque_constant_Nm_per_A;
  if (effects_.winding.empty()) {
    s.winding = winding_;
    return;
  }
  WindingPort<T> port;
  port.current_A = state.current_A;
  port.omega_rotor_rad_s = s.omega_mid;
  port.theta_rotor_rad = s.theta_mid;
  port.heat_W = state.heat_W;
  port.pole_pairs = params_.pole_pairs;
  port.wheel = input.wheel;
  port.dt_s = step_s_;
  port.resistance_ohm = params_.resistance_ohm;
  port.inductance_H = params_.inductance_H;
  port.torque_constant_Nm_per_A = port.back_emf_V_s_per_rad = params_.torque_constant_Nm_per_A;
  port.temperature_rise_K = state.temperature_rise_K;
  effects_.winding.apply(effects_.values(), state.effects.data(), port);
  state.temperature_rise_K = port.temperature_rise_K;
  s.k = port.torque_constant_Nm_per_A;
  s.k_emf = port.back_emf_V_s_per_rad;
  s.emf_offset = port.back_emf_offset_V;
  const bool same =
      port.resistance_ohm == params_.resistance_ohm && port.inductance_H == params_.inductance_H;
  s.winding = std::is_same_v<T, double> && same
                  ? winding_
                  : make_winding_step(port.resistance_ohm, port.inductance_H, step_s_);
}

template <typename T>
void DriveSim<T>::bridge(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  const bool by_duty = input.kind == CommandKind::kDuty || input.kind == CommandKind::kPositionTarget;
  BridgePort<T> port;
  if (by_duty) {
    port.voltage_V = s.asked * s.bus_voltage;
  } else if (input.kind == CommandKind::kMotorVoltage) {
    // A bridge asked for a voltage is limited only where an effect limits its duty.
    port.voltage_V = value_of(s.duty_limit) < 1.0 ? clamped(s.asked, s.duty_limit * s.bus_voltage) : s.asked;
  }
  if (value_of(params_.current_limit_A) > 0.0)
    port.inverse_current_limit_per_A = 1.0 / params_.current_limit_A;
  if (!effects_.bridge.empty() && input.kind != CommandKind::kMotorTorque) {
    port.kind = input.kind;
    port.duty_ratio = by_duty ? s.asked : T(0);
    port.bus_voltage_V = s.bus_voltage;
    port.current_A = state.current_A;
    port.back_emf_V = s.k_emf * s.omega_mid + s.emf_offset;
    port.temperature_rise_K = state.temperature_rise_K;
    port.pwm_frequency_Hz = params_.pwm_frequency_Hz;
    port.dt_s = step_s_;
    effects_.bridge.apply(effects_.values(), state.effects.data(), port);
  }
  s.voltage = port.voltage_V;
  s.inverse_limit = port.inverse_current_limit_per_A;
  s.electric = by_duty || input.kind == CommandKind::kMotorVoltage;
  if (input.kind == CommandKind::kMotorCurrent) {
    s.current = value_of(s.inverse_limit) > 0.0 ? clamped(s.asked, 1.0 / s.inverse_limit) : s.asked;
  } else if (input.kind == CommandKind::kMotorTorque) {
    s.applied_torque = s.asked;
  }
  if (input.enabled) return;
  // All switches off: the current dies against the bus, then nothing flows below the bus voltage.
  s.applied_torque = s.current = T(0);
  if (!s.electric) return;
  const T emf = s.k_emf * s.omega_mid + s.emf_offset;
  const double flows = sign_of(state.current_A);
  if (flows != 0.0) {
    s.voltage = -flows * s.bus_voltage;
  } else if (value_of(emf) > value_of(s.bus_voltage) || value_of(emf) < -value_of(s.bus_voltage)) {
    s.voltage = sign_of(emf) * s.bus_voltage;
  } else {
    s.electric = false;
    s.open = true;
  }
}

template <typename T>
void DriveSim<T>::torque(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  s.tau_outside = input.tau_outside_Nm;
  T tau = input.tau_outside_Nm;
  if (!is_exactly(params_.gravity_torque_Nm, 0.0)) {
    using std::sin;
    // tau = -m g l sin(theta_out) / N
    tau -= params_.gravity_torque_Nm * sin(s.theta_mid * inverse_gear_) * inverse_gear_;
  }
  s.load.inertia_kg_m2 = inertia_kg_m2_;
  TorquePort<T> port;
  port.friction_positive_Nm = port.friction_negative_Nm = params_.coulomb_friction_Nm;
  port.viscous_positive_Nm_s_per_rad = port.viscous_negative_Nm_s_per_rad =
      params_.viscous_friction_Nm_s_per_rad;
  if (!effects_.torque.empty()) {
    port.omega_rotor_rad_s = s.omega_mid;
    port.theta_rotor_rad = s.theta_mid;
    port.omega_output_rad_s = s.omega_mid * inverse_gear_;
    port.theta_output_rad = s.theta_mid * inverse_gear_;
    port.tau_motor_Nm = s.applied_torque + s.k * s.current;
    if (s.electric) {
      const T net = s.voltage - s.emf_offset - s.k_emf * s.omega_mid;
      port.tau_motor_Nm = s.k * s.winding.mean_current(net, state.current_A);
    }
    port.tau_load_Nm = tau;
    port.gear_ratio = params_.gear_ratio;
    port.inertia_kg_m2 = inertia_kg_m2_;
    port.dt_s = step_s_;
    effects_.torque.apply(effects_.values(), state.effects.data(), port);
  }
  s.load.torque_Nm = tau + port.tau_Nm + s.applied_torque;
  s.load.damping_positive_Nm_s_per_rad = port.viscous_positive_Nm_s_per_rad;
  s.load.damping_negative_Nm_s_per_rad = port.viscous_negative_Nm_s_per_rad;
  s.load.friction_positive_Nm = port.friction_positive_Nm;
  s.load.friction_negative_Nm = port.friction_negative_Nm;
}

// ------------------------------------------------------------------------------- winding and rotor, together

// The rotor with all torques in s.load, or the bench's speed and the torque it needs.
template <typename T>
void DriveSim<T>::turn(const DriveState<T>& state, Step& s) const {
  if (!s.imposed) {
    const RotorStep<T> r = advance_rotor(state.omega_rotor_rad_s, step_s_, s.load);
    s.mean_omega = r.mean_omega_rad_s;
    s.omega_end = r.omega_end_rad_s;
    s.held = r.held;
    s.outside = s.tau_outside;
    return;
  }
  s.omega_end = s.imposed_end;
  s.mean_omega = 0.5 * (s.omega_start + s.omega_end);
  const double direction = sign_of(s.mean_omega);
  // tau_outside = J domega/dt - (sum of the others), friction at rest taking what it can
  T inside = s.load.torque_Nm - s.tau_outside;
  if (direction > 0.0) {
    inside -= s.load.friction_positive_Nm + s.load.damping_positive_Nm_s_per_rad * s.mean_omega;
  } else if (direction < 0.0) {
    inside += s.load.friction_negative_Nm - s.load.damping_negative_Nm_s_per_rad * s.mean_omega;
  } else if (inside > s.load.friction_positive_Nm) {
    inside -= s.load.friction_positive_Nm;
  } else if (inside < -s.load.friction_negative_Nm) {
    inside += s.load.friction_negative_Nm;
  } else {
    inside = T(0);
    s.held = true;
  }
  s.outside = inertia_kg_m2_ * (s.omega_end - s.omega_start) / step_s_ - inside;
}

// Solves again with the mean current given instead of the voltage.
template <typename T>
void DriveSim<T>::hold_current(const DriveState<T>& state, const T& end_current_A, const T& mean_current_A,
                               Step& s) const {
  const RotorLoad<T> without_winding = s.load;
  s.load.torque_Nm += s.k * mean_current_A;
  turn(state, s);
  s.load = without_winding;
  s.mean_current = mean_current_A;
  s.end_current = end_current_A;
}

template <typename T>
void DriveSim<T>::solve(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  if (!s.electric) {
    hold_current(state, s.current, s.current, s);
    return;
  }
  const T& i0 = state.current_A;
  const RotorLoad<T> without_winding = s.load;
  // mean i = gain (u - e0 - k_emf mean omega) + phi i_0: a torque and a damping
  const T damping = s.k * s.winding.gain * s.k_emf;
  s.load.torque_Nm += s.k * s.winding.mean_current(s.voltage - s.emf_offset, i0);
  s.load.damping_positive_Nm_s_per_rad += damping;
  s.load.damping_negative_Nm_s_per_rad += damping;
  turn(state, s);
  s.load = without_winding;
  const T net = s.voltage - s.emf_offset - s.k_emf * s.mean_omega;
  s.mean_current = s.winding.mean_current(net, i0);
  s.end_current = s.winding.end_current(net, i0);
  if (!input.enabled) {
    const double flows = sign_of(i0);
    if (flows != 0.0 && flows * value_of(s.end_current) < 0.0) {
      // Reaches zero after i_0 / (i_0 - i_1) of the sub-step, near enough on a straight line, and stays
      // there.
      hold_current(state, T(0), 0.5 * i0 * i0 / (i0 - s.end_current), s);
    }
    return;
  }
  const double limit_A = value_of(s.inverse_limit) > 0.0 ? 1.0 / value_of(s.inverse_limit) : 0.0;
  if (limit_A > 0.0 && std::abs(value_of(s.end_current)) > limit_A) {
    // A chopper turns the bridge down as far as the current needs, if the bus can oppose it at all.
    const T limited = sign_of(s.end_current) / s.inverse_limit;
    const T mean = 0.5 * (clamped(i0, 1.0 / s.inverse_limit) + limited);
    const T needed = s.winding.resistance_ohm * limited + s.k_emf * s.mean_omega + s.emf_offset;
    if (std::abs(value_of(needed)) > value_of(s.bus_voltage)) return;
    hold_current(state, limited, mean, s);
    s.voltage = s.winding.resistance_ohm * mean + s.k_emf * s.mean_omega + s.emf_offset +
                s.winding.inductance_H * (limited - i0) / step_s_;
  }
}

template <typename T>
void DriveSim<T>::step(DriveState<T>& state, const DriveInput<T>& input, double imposed_start_rad_s,
                       double imposed_end_rad_s, DriveResult<T>& sums) const {
  Step s;
  s.imposed = input.speed_is_imposed;
  s.omega_start = s.imposed ? T(imposed_start_rad_s) : state.omega_rotor_rad_s;
  s.imposed_end = T(imposed_end_rad_s);
  // omega(t + h/2) = omega + (omega - omega before) / 2, unless that would turn round
  s.omega_mid =
      s.imposed ? 0.5 * (s.omega_start + s.imposed_end) : s.omega_start + 0.5 * state.omega_change_rad_s;
  if (!s.imposed && sign_of(s.omega_mid) != sign_of(s.omega_start)) s.omega_mid = s.omega_start;
  s.theta_mid = state.theta_rotor_rad + 0.25 * step_s_ * (s.omega_start + s.omega_mid);
  command(state, input, s);
  supply(state, input, s);
  winding(state, input, s);
  bridge(state, input, s);
  torque(state, input, s);
  solve(state, input, s);

  const T& i0 = state.current_A;
  const T power = s.voltage * s.mean_current;
  // heat = (u - back-EMF) i - change of L i^2 / 2
  T heat_J = s.winding.resistance_ohm * s.mean_current * s.mean_current * step_s_;
  if (s.electric) {
    heat_J = (s.voltage - s.emf_offset - s.k_emf * s.mean_omega) * s.mean_current * step_s_ -
             0.5 * s.winding.inductance_H * (s.end_current * s.end_current - i0 * i0);
    sums.electrical_energy_J += power * step_s_;
    sums.mean_bus_current_A += power / s.bus_voltage;
  }
  sums.mean_current_A += s.mean_current;
  sums.mean_voltage_V += s.voltage;
  sums.bus_voltage_V = s.bus_voltage;
  sums.heat_J += heat_J;
  sums.mean_outside_torque_Nm += s.outside;
  sums.mean_shaft_torque_Nm += inertia_kg_m2_ * (s.omega_end - s.omega_start) / step_s_ - s.outside;
  sums.held = sums.held && s.held;
  state.heat_W = heat_J / step_s_;
  state.current_A = s.end_current;
  state.omega_change_rad_s = s.omega_end - s.omega_start;
  state.omega_rotor_rad_s = s.omega_end;
  state.theta_rotor_rad += s.mean_omega * step_s_;
  state.now_s += step_s_;
}

// ------------------------------------------------------------------------------------------------ whole
// calls

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
                  ? clamped(T(input.setpoint), params_.duty_limit_ratio) * r.bus_voltage_V
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

template <typename T>
DriveResult<T> DriveSim<T>::advance(DriveState<T>& state, const DriveInput<T>& input, int substeps) const {
  assert(substeps > 0);
  if (plain(input)) return advance_plain(state, input, substeps);
  if (!effects_.command.empty()) state.commands.push(state.now_s, input.setpoint);
  DriveResult<T> sums;
  sums.held = true;
  const double slope = (input.imposed_end_rad_s - input.imposed_start_rad_s) / substeps;
  for (int n = 0; n < substeps; ++n) {
    step(state, input, input.imposed_start_rad_s + n * slope, input.imposed_start_rad_s + (n + 1) * slope,
         sums);
  }
  const double share = 1.0 / substeps;
  sums.mean_current_A *= share;
  sums.mean_voltage_V *= share;
  sums.mean_bus_current_A *= share;
  sums.mean_outside_torque_Nm *= share;
  sums.mean_shaft_torque_Nm *= share;
  return sums;
}

template class DriveSim<double>;
template class DriveSim<Jet>;

}  // namespace omnihil
