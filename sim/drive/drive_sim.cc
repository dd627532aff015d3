#include "sim/drive/drive_sim.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "sim/drive/imposed_speed.h"
#include "sim/drive/shaft_step.h"
#include "sim/drive/solve_bridge.h"

namespace omnihil {
namespace {

template <typename T>
T clamped(const T& x, const T& limit) {
  return x > limit ? limit : (x < -limit ? -limit : x);
}

// Equal, with no unknown behind either.
bool same(double a, double b) { return a == b; }
bool same(const Jet& a, const Jet& b) { return a.a == b.a && a.v == b.v; }

// One sub-step is one piece of code: a part called for real would need its numbers in memory (measured: 15 of 80 ns).
#define INLINE [[gnu::always_inline]] inline
}  // namespace

template <typename T>
struct DriveSim<T>::Call {
  bool by_duty = false;
  bool electric = false;
  T bus_voltage = T(0), inverse_bus = T(0);
};

template <typename T>
struct DriveSim<T>::Step {
  double imposed_start = 0.0, imposed_end = 0.0;
  T omega_mid, theta_mid;
  T asked, duty_limit;  // asked: duty, V, A or N m
  T bus_voltage, inverse_bus;
  T voltage, inverse_limit;
  WindingStep<T> winding;
  T k, k_emf, emf_offset;
  T current;          // mean, where not electric
  T applied_torque;   // of torque controlled drives
  RotorLoad<T> load;  // without the winding's part
  T tau_outside;
  T mean_omega, omega_end, mean_current, end_current, outside;
  bool electric = false;  // winding is solved together with the rotor
  bool imposed = false, held = false;
  T tau_load;  // gravity and outside, at the rotor
  T through_shaft;
  ShaftStep<T> shaft;
};

template <typename T>
DriveSim<T>::DriveSim(const DriveParams<T>& params, EffectSet<T> effects, double step_s)
    : params_(params), effects_(std::move(effects)), step_s_(step_s) {
  inertia_kg_m2_ = inertia_at_rotor(params_);
  inverse_gear_ = 1.0 / params_.gear_ratio;
  two_masses_ = !effects_.shaft.empty() && value_of(params_.load_inertia_kg_m2) > 0.0 &&
                value_of(params_.rotor_inertia_kg_m2) > 0.0;
  if (value_of(params_.current_limit_A) > 0.0) base_inverse_limit_per_A_ = 1.0 / params_.current_limit_A;
  assert(value_of(inertia_kg_m2_) > 0.0);
  set_step(step_s);
}

template <typename T>
void DriveSim<T>::set_step(double step_s) {
  assert(step_s > 0.0);
  step_s_ = step_s;
  inductance_over_step_ = params_.inductance_H / step_s;
  if (value_of(params_.inductance_H) > 0.0) step_over_inductance_ = step_s / params_.inductance_H;
  if (value_of(params_.resistance_ohm) > 0.0) {
    winding_ = make_winding_step(params_.resistance_ohm, params_.inductance_H, inductance_over_step_,
                                 step_over_inductance_);
  }
}

template <typename T>
DriveState<T> DriveSim<T>::initial_state() const {
  DriveState<T> state;
  restart(state);
  return state;
}

template <typename T>
void DriveSim<T>::restart(DriveState<T>& state) const {
  static_cast<DriveMotion<T>&>(state) = {};
  if (state.commands.count > 0) state.commands = {};
  std::copy(effects_.initial_states().begin(), effects_.initial_states().end(), state.effects.begin());
}

// ------------------------------------------------------------------------------------ the places, in order

template <typename T>
INLINE void DriveSim<T>::command(DriveState<T>& state, const DriveInput<T>& input, const Call& call,
                                 Step& s) const {
  s.asked = T(input.setpoint);
  s.duty_limit = params_.duty_limit_ratio;
  if (!effects_.command.empty()) {
    CommandPort<T> port;
    port.kind = input.kind;
    port.setpoint = s.asked;
    port.duty_limit_ratio = s.duty_limit;
    port.history = &state.commands;
    port.now_s = state.now_s;
    port.dt_s = step_s_;
    port.position_rad = s.theta_mid * inverse_gear_;
    effects_.command.apply(effects_.values(), state.effects.data(), port);
    s.asked = port.setpoint;
    s.duty_limit = port.duty_limit_ratio;
  }
  if (input.kind == CommandKind::kPositionTarget) {
    // duty = kp (target - position), held within the servo's limit
    s.asked = clamped(T(params_.servo_kp_duty_per_rad * (s.asked - s.theta_mid * inverse_gear_)),
                      params_.servo_duty_limit_ratio);
  }
  if (call.by_duty) s.asked = clamped(s.asked, s.duty_limit);
}

template <typename T>
INLINE void DriveSim<T>::supply(DriveState<T>& state, const DriveInput<T>& input, const Call& call,
                                Step& s) const {
  s.bus_voltage = call.bus_voltage;
  s.inverse_bus = call.inverse_bus;
  if (input.bus_is_measured || effects_.supply.empty()) return;
  SupplyPort<T> port;
  const T duty = input.kind == CommandKind::kMotorVoltage ? T(s.asked * s.inverse_bus) : s.asked;
  port.bus_current_A = input.other_bus_current_A;
  if (input.enabled && call.electric) port.bus_current_A += duty * state.current_A;
  port.dt_s = step_s_;
  port.bus_voltage_V = s.bus_voltage;
  effects_.supply.apply(effects_.values(), state.effects.data(), port);
  s.bus_voltage = port.bus_voltage_V;
  s.inverse_bus = 1.0 / s.bus_voltage;
}

// Before the bridge, because the bridge looks at the back-EMF; the bridge changes nothing the winding reads.
template <typename T>
INLINE void DriveSim<T>::winding(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  s.winding = winding_;
  s.k = s.k_emf = params_.torque_constant_Nm_per_A;
  s.emf_offset = T(0);
  if (effects_.winding.empty()) return;
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
  const bool same_inductance = same(port.inductance_H, params_.inductance_H);
  if (same_inductance && same(port.resistance_ohm, params_.resistance_ohm)) return;
  T over_step = inductance_over_step_, inverse = step_over_inductance_;
  if (!same_inductance) {
    over_step = port.inductance_H / step_s_;
    inverse = step_s_ / port.inductance_H;
  }
  s.winding = make_winding_step(port.resistance_ohm, port.inductance_H, over_step, inverse);
}

template <typename T>
INLINE void DriveSim<T>::bridge(DriveState<T>& state, const DriveInput<T>& input, const Call& call,
                                Step& s) const {
  s.voltage = T(0);
  if (call.by_duty) {
    s.voltage = s.asked * s.bus_voltage;
  } else if (call.electric) {
    // A bridge asked for a voltage is limited only where an effect limits its duty.
    s.voltage = value_of(s.duty_limit) < 1.0 ? clamped(s.asked, T(s.duty_limit * s.bus_voltage)) : s.asked;
  }
  s.inverse_limit = base_inverse_limit_per_A_;
  if (!effects_.bridge.empty() && input.kind != CommandKind::kMotorTorque) {
    BridgePort<T> port;
    port.kind = input.kind;
    if (call.by_duty) port.duty_ratio = s.asked;
    port.bus_voltage_V = s.bus_voltage;
    port.current_A = state.current_A;
    port.back_emf_V = s.k_emf * s.omega_mid + s.emf_offset;
    port.temperature_rise_K = state.temperature_rise_K;
    port.resistance_ohm = s.winding.resistance_ohm;
    port.pwm_frequency_Hz = params_.pwm_frequency_Hz;
    port.dt_s = step_s_;
    port.voltage_V = s.voltage;
    port.inverse_current_limit_per_A = s.inverse_limit;
    if (effects_.bridge_reads_current() && call.electric && input.enabled) {
      const T opposing_V = s.emf_offset + s.k_emf * s.omega_mid;
      const auto law = [&] { effects_.bridge.apply(effects_.values(), state.effects.data(), port); };
      solve_bridge(s.winding, opposing_V, state.current_A, law, port);
    } else {
      effects_.bridge.apply(effects_.values(), state.effects.data(), port);
    }
    s.voltage = port.voltage_V;
    s.inverse_limit = port.inverse_current_limit_per_A;
  }
  s.electric = call.electric;
  s.current = s.applied_torque = T(0);
  if (input.kind == CommandKind::kMotorCurrent) {
    s.current = value_of(s.inverse_limit) > 0.0 ? clamped(s.asked, T(1.0 / s.inverse_limit)) : s.asked;
  } else if (input.kind == CommandKind::kMotorTorque) {
    s.applied_torque = s.asked;
  }
  if (!input.enabled) [[unlikely]]
    release(state, s);
}

// All switches off: the current dies against the bus, then nothing flows below the bus voltage.
template <typename T>
INLINE void DriveSim<T>::release(const DriveState<T>& state, Step& s) const {
  s.applied_torque = s.current = T(0);
  if (!s.electric) return;
  const T emf = s.k_emf * s.omega_mid + s.emf_offset;
  const double flows = sign_of(state.current_A);
  if (flows != 0.0) {
    s.voltage = -flows * s.bus_voltage;
  } else if (std::abs(value_of(emf)) > value_of(s.bus_voltage)) {
    s.voltage = sign_of(emf) * s.bus_voltage;
  } else {
    s.electric = false;
  }
}

template <typename T>
INLINE void DriveSim<T>::torque(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  s.tau_outside = input.tau_outside_Nm;
  T tau = input.tau_outside_Nm;
  if (!is_exactly(params_.gravity_torque_Nm, 0.0)) {
    using std::sin;
    // tau = -m g l sin(theta_out) / N
    const T theta_out = two_masses_ ? state.theta_output_rad : T(s.theta_mid * inverse_gear_);
    tau -= params_.gravity_torque_Nm * sin(theta_out) * inverse_gear_;
  }
  s.tau_load = tau;
  const T &friction = params_.coulomb_friction_Nm, &viscous = params_.viscous_friction_Nm_s_per_rad;
  s.load = {inertia_kg_m2_, tau + s.applied_torque, viscous, viscous, friction, friction};
  if (effects_.torque.empty()) return;
  TorquePort<T> port;
  port.omega_rotor_rad_s = s.omega_mid;
  port.theta_rotor_rad = s.theta_mid;
  port.travel_rad = s.theta_mid - state.corrected_rad;
  port.omega_output_rad_s = s.omega_mid * inverse_gear_;
  port.theta_output_rad = s.theta_mid * inverse_gear_;
  if (two_masses_) {
    port.omega_output_rad_s = state.omega_output_rad_s;
    port.theta_output_rad = state.theta_output_rad;
  }
  if (s.electric) {
    const T net = s.voltage - s.emf_offset - s.k_emf * s.omega_mid;
    port.tau_motor_Nm = s.k * s.winding.mean_current(net, state.current_A);
  } else {
    port.tau_motor_Nm = s.applied_torque + s.k * s.current;
  }
  port.tau_load_Nm = tau;
  port.gear_ratio = params_.gear_ratio;
  port.inertia_kg_m2 = inertia_kg_m2_;
  port.dt_s = step_s_;
  port.friction_positive_Nm = port.friction_negative_Nm = friction;
  port.viscous_positive_Nm_s_per_rad = port.viscous_negative_Nm_s_per_rad = viscous;
  if (input.motor_torque_is_needed && s.imposed && !two_masses_ && effects_.reads_motor_torque()) [[unlikely]]
    port.tau_motor_Nm = inverse_torque(state, s.imposed_start, s.imposed_end, s.tau_outside, port);
  effects_.torque.apply(effects_.values(), state.effects.data(), port);
  s.load.torque_Nm += port.tau_Nm;
  s.load.damping_positive_Nm_s_per_rad = port.viscous_positive_Nm_s_per_rad;
  s.load.damping_negative_Nm_s_per_rad = port.viscous_negative_Nm_s_per_rad;
  s.load.friction_positive_Nm = port.friction_positive_Nm;
  s.load.friction_negative_Nm = port.friction_negative_Nm;
}

// Takes the load off the rotor and joins it to the output instead.
template <typename T>
INLINE void DriveSim<T>::join_shaft(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  const T rotor_speed = state.omega_rotor_rad_s * inverse_gear_;
  ShaftPort<T> port;
  port.twist_rad = state.theta_rotor_rad * inverse_gear_ - state.theta_output_rad;
  port.twist_rate_rad_s = rotor_speed - state.omega_output_rad_s;
  port.gear_ratio = params_.gear_ratio;
  port.dt_s = step_s_;
  effects_.shaft.apply(effects_.values(), state.effects.data(), port);
  ShaftOutput<T> output;
  output.rotor_inertia_kg_m2 = params_.rotor_inertia_kg_m2 * params_.gear_ratio * params_.gear_ratio;
  output.inertia_kg_m2 = params_.load_inertia_kg_m2;
  output.omega_rad_s = state.omega_output_rad_s;
  output.torque_Nm = s.tau_load * params_.gear_ratio;
  output.imposed = input.speed_is_imposed && !s.imposed;
  output.imposed_mean_rad_s = T(0.5 * (s.imposed_start + s.imposed_end)) * inverse_gear_;
  s.shaft = make_shaft_step(port, output, step_s_);
  // rotor: -tau_shaft / N, a torque and a damping
  s.load.inertia_kg_m2 = params_.rotor_inertia_kg_m2;
  s.load.torque_Nm -= s.tau_load + s.shaft.torque_Nm * inverse_gear_;
  const T damping = s.shaft.damping_Nm_s_per_rad * inverse_gear_ * inverse_gear_;
  s.load.damping_positive_Nm_s_per_rad += damping;
  s.load.damping_negative_Nm_s_per_rad += damping;
}

// The output, after the rotor.
template <typename T>
INLINE void DriveSim<T>::turn_output(DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  const T torque = s.shaft.torque_Nm + s.shaft.damping_Nm_s_per_rad * s.mean_omega * inverse_gear_;
  const T& inertia = params_.load_inertia_kg_m2;
  const bool imposed = input.speed_is_imposed && !s.imposed;
  const T before = imposed ? T(s.imposed_start * inverse_gear_) : state.omega_output_rad_s;
  // J_out dw/dt = tau_shaft + tau_load N; where the speed is imposed that is what the bench must add
  if (imposed) {
    state.omega_output_rad_s = s.imposed_end * inverse_gear_;
    const T needed = inertia * (state.omega_output_rad_s - before) / step_s_;
    s.outside = s.tau_outside + (needed - torque) * inverse_gear_ - s.tau_load;
  } else {
    state.omega_output_rad_s = before + step_s_ * (torque + s.tau_load * params_.gear_ratio) / inertia;
  }
  state.theta_output_rad += 0.5 * step_s_ * (before + state.omega_output_rad_s);
  s.through_shaft = torque * inverse_gear_;
}

// --------------------------------------------------------------------------- winding and rotor, together

// The rotor with all torques in s.load.
template <typename T>
INLINE void DriveSim<T>::turn(const DriveState<T>& state, Step& s) const {
  if (s.imposed) [[unlikely]] {
    RotorLoad<T> load = s.load;
    if (two_masses_) load.torque_Nm += s.tau_outside;  // acts on the output, what the bench adds on the rotor
    const ImposedSpeed<T> bench =
        impose_speed(s.imposed_start, s.imposed_end, step_s_, load.inertia_kg_m2, s.tau_outside, load);
    s.omega_end = T(s.imposed_end);
    s.mean_omega = T(0.5 * (s.imposed_start + s.imposed_end));
    s.outside = bench.outside_Nm;
    s.held = bench.held;
    return;
  }
  const RotorStep<T> r = advance_rotor(state.omega_rotor_rad_s, step_s_, s.load);
  s.mean_omega = r.mean_omega_rad_s;
  s.omega_end = r.omega_end_rad_s;
  s.held = r.held;
  s.outside = s.tau_outside;
}

// Solves with the mean current given instead of the voltage.
template <typename T>
INLINE void DriveSim<T>::hold_current(const DriveState<T>& state, const T& end_current_A,
                                      const T& mean_current_A, Step& s) const {
  const T without_winding = s.load.torque_Nm;
  s.load.torque_Nm += s.k * mean_current_A;
  turn(state, s);
  s.load.torque_Nm = without_winding;
  s.mean_current = mean_current_A;
  s.end_current = end_current_A;
}

template <typename T>
INLINE void DriveSim<T>::solve(const DriveState<T>& state, const DriveInput<T>& input, Step& s) const {
  if (!s.electric) [[unlikely]]
    return hold_current(state, s.current, s.current, s);
  const WindingStep<T>& w = s.winding;
  const T& i0 = state.current_A;
  const T free_voltage = s.voltage - s.emf_offset;
  const RotorLoad<T> without_winding = s.load;
  // mean i = gain (u - e0 - k_emf mean omega) + phi i_0: a torque and a damping
  const T damping = s.k * w.gain * s.k_emf;
  s.load.torque_Nm += s.k * w.mean_current(free_voltage, i0);
  s.load.damping_positive_Nm_s_per_rad += damping;
  s.load.damping_negative_Nm_s_per_rad += damping;
  turn(state, s);
  const T net = free_voltage - s.k_emf * s.mean_omega;
  s.mean_current = w.mean_current(net, i0);
  s.end_current = w.end_current(net, i0);
  const double i1 = value_of(s.end_current);
  const bool dies = !input.enabled && value_of(i0) * i1 < 0.0;
  const bool limited = input.enabled && std::abs(i1) * value_of(s.inverse_limit) > 1.0;
  if (!dies && !limited) [[likely]]
    return;
  s.load = without_winding;
  if (limited) return limit_current(state, s);
  // Reaches zero after i_0 / (i_0 - i_1) of the sub-step, near enough on a straight line, and stays there.
  hold_current(state, T(0), T(0.5 * i0 * i0 / (i0 - s.end_current)), s);
}

// A chopper turns the bridge down as far as the current needs, if the bus can oppose it at all.
template <typename T>
INLINE void DriveSim<T>::limit_current(const DriveState<T>& state, Step& s) const {
  const T limit = 1.0 / s.inverse_limit;
  const T end = sign_of(s.end_current) * limit;
  const T mean = 0.5 * (clamped(state.current_A, limit) + end);
  const T needed = s.winding.resistance_ohm * end + s.k_emf * s.mean_omega + s.emf_offset;
  if (std::abs(value_of(needed)) > value_of(s.bus_voltage)) return;
  hold_current(state, end, mean, s);
  // u = R i + back-EMF + L di/dt
  s.voltage = s.winding.resistance_ohm * mean + s.k_emf * s.mean_omega + s.emf_offset +
              s.winding.inductance_H * (end - state.current_A) / step_s_;
}

template <typename T>
INLINE void DriveSim<T>::step(DriveState<T>& state, const DriveInput<T>& input, const Call& call, Step& s,
                              DriveResult<T>& sums) const {
  s.imposed = input.speed_is_imposed && (!two_masses_ || input.rotor_is_imposed);
  s.held = false;
  T omega_start = state.omega_rotor_rad_s;
  if (s.imposed) {
    omega_start = T(s.imposed_start);
    s.omega_mid = T(0.5 * (s.imposed_start + s.imposed_end));
  } else {
    // omega(t + h/2) = omega + (omega - omega before) / 2, unless that would turn round
    s.omega_mid = omega_start + 0.5 * state.omega_change_rad_s;
    if (value_of(s.omega_mid) * value_of(omega_start) <= 0.0) s.omega_mid = omega_start;
  }
  s.theta_mid = state.theta_rotor_rad + 0.25 * step_s_ * (omega_start + s.omega_mid);
  command(state, input, call, s);
  supply(state, input, call, s);
  winding(state, input, s);
  bridge(state, input, call, s);
  torque(state, input, s);
  if (two_masses_) [[unlikely]]
    join_shaft(state, input, s);
  solve(state, input, s);
  if (two_masses_) [[unlikely]]
    turn_output(state, input, s);

  const T& i0 = state.current_A;
  if (s.electric) {
    const T power = s.voltage * s.mean_current;
    // heat = (u - back-EMF) i - change of L i^2 / 2, as mean power
    state.heat_W = power - (s.emf_offset + s.k_emf * s.mean_omega) * s.mean_current -
                   0.5 * s.winding.inductance_H * (s.end_current * s.end_current - i0 * i0) * (1.0 / step_s_);
    sums.electrical_energy_J += power;
    sums.mean_bus_current_A += power * s.inverse_bus;
    sums.mean_voltage_V += s.voltage;
  } else {
    state.heat_W = s.winding.resistance_ohm * s.mean_current * s.mean_current;
  }
  sums.mean_current_A += s.mean_current;
  sums.heat_J += state.heat_W;
  sums.mean_outside_torque_Nm += s.outside;
  if (two_masses_) sums.mean_shaft_torque_Nm += s.through_shaft;
  sums.held = sums.held && s.held;
  state.current_A = s.end_current;
  state.omega_change_rad_s = s.omega_end - omega_start;
  state.omega_rotor_rad_s = s.omega_end;
  state.theta_rotor_rad += s.mean_omega * step_s_;
  state.now_s += step_s_;
}

template <typename T>
DriveResult<T> DriveSim<T>::advance(DriveState<T>& state, const DriveInput<T>& input, int substeps) const {
  assert(substeps > 0);
  if (plain(input)) return advance_plain(state, input, substeps);
  if (!effects_.command.empty()) state.commands.push(state.now_s, value_of(input.setpoint));
  if (two_masses_ && !state.has_output) {
    state.theta_output_rad = state.theta_rotor_rad * inverse_gear_;
    state.omega_output_rad_s = state.omega_rotor_rad_s * inverse_gear_;
    state.has_output = true;
  }
  Call call;
  call.by_duty = input.kind == CommandKind::kDuty || input.kind == CommandKind::kPositionTarget;
  call.electric = call.by_duty || input.kind == CommandKind::kMotorVoltage;
  call.bus_voltage = input.bus_is_measured ? T(input.bus_voltage_V) : params_.supply_voltage_V;
  if (value_of(call.bus_voltage) > 0.0) call.inverse_bus = 1.0 / call.bus_voltage;
  DriveResult<T> sums;
  sums.held = true;
  Step s;  // lent to nobody: its numbers stay in registers
  s.bus_voltage = call.bus_voltage;
  const T omega_first = input.speed_is_imposed ? T(input.imposed_start_rad_s) : state.omega_rotor_rad_s;
  const double slope = (input.imposed_end_rad_s - input.imposed_start_rad_s) / substeps;
  for (int n = 0; n < substeps; ++n) {
    s.imposed_start = input.imposed_start_rad_s + n * slope;
    s.imposed_end = input.imposed_start_rad_s + (n + 1) * slope;
    step(state, input, call, s, sums);
  }
  const double share = 1.0 / substeps;
  sums.bus_voltage_V = s.bus_voltage;
  sums.electrical_energy_J *= step_s_;
  sums.heat_J *= step_s_;
  sums.mean_current_A *= share;
  sums.mean_voltage_V *= share;
  sums.mean_bus_current_A *= share;
  sums.mean_outside_torque_Nm *= share;
  if (two_masses_) {
    sums.mean_shaft_torque_Nm *= share;
  } else {
    sums.mean_shaft_torque_Nm =
        inertia_kg_m2_ * (state.omega_rotor_rad_s - omega_first) / (substeps * step_s_) -
        sums.mean_outside_torque_Nm;
  }
  return sums;
}

#undef INLINE

template class DriveSim<double>;
template class DriveSim<Jet>;

}  // namespace omnihil
