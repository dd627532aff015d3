#include "sim/rolling/rolling_robot.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/robot/link_effect.h"
#include "sim/rolling/rolling_step.h"

namespace omnihil {
// What the plant takes out of a drive's chain of torques: its friction, to be solved with the floor's force.
template <typename T>
struct RollingRobot<T>::Link {
  T friction_positive_Nm = T(0), friction_negative_Nm = T(0);
  T inverse_limit_per_A = T(0);
};

// Last in the chains of bridge and torque, by its name.
template <typename T>
struct RollingRobot<T>::LinkEffect {
  static constexpr EffectInfo kInfo = link_info("Link between drive and body", "", "rolling_robot.h");
  static Link& link(const void* context) { return *static_cast<Link*>(const_cast<void*>(context)); }
  static void bridge(const void* context, const T*, T*, BridgePort<T>& port) {
    link(context).inverse_limit_per_A = port.inverse_current_limit_per_A;
  }
  static void torque(const void* context, const T*, T*, TorquePort<T>& port) {
    link(context).friction_positive_Nm = port.friction_positive_Nm;
    link(context).friction_negative_Nm = port.friction_negative_Nm;
    port.friction_positive_Nm = port.friction_negative_Nm = T(0);
  }
};

template <typename T>
RollingRobot<T>::RollingRobot(const RollingParams<T>& params, std::span<const EffectUse> uses,
                              std::span<const T> values)
    : p_(params), effects_(uses, values), wheels_(params.wheels), step_(std::make_unique<Step>()) {
  absent_.rolls = false;
  absent_.full_grip_m_s = T(1);
  make_body();
  link_entries_.resize(wheels_);
  std::vector<T> with_link(values.begin(), values.end());
  with_link.push_back(T(1));
  for (std::size_t i = 0; i < wheels_; ++i) {
    links_.push_back(std::make_unique<Link>());
    EffectEntry& entry = link_entries_[i];
    entry.info = &LinkEffect::kInfo;
    if constexpr (std::is_same_v<T, double>) {
      entry.simulate.bridge = LinkEffect::bridge;
      entry.simulate.torque = LinkEffect::torque;
    } else {
      entry.differentiate.bridge = LinkEffect::bridge;
      entry.differentiate.torque = LinkEffect::torque;
    }
    entry.context = links_[i].get();
    std::vector<EffectUse> all(uses.begin(), uses.end());
    all.push_back({.entry = &entry, .values = {1.0}, .tolerances = {}, .name = {}, .owner = {}});
    drives_.emplace_back(p_.drive, EffectSet<T>(all, with_link), 1e-3);
  }
}

template <typename T>
RollingRobot<T>::~RollingRobot() = default;

// Masses, with what body effects make of them.
template <typename T>
void RollingRobot<T>::make_body() {
  if (!effects_.body.empty()) {
    BodyPort<T> port;
    port.mass_kg = p_.mass_kg;
    port.yaw_inertia_kg_m2 = p_.yaw_inertia_kg_m2;
    port.center_of_mass_x_m = p_.center_of_mass_x_m;
    port.center_of_mass_y_m = p_.center_of_mass_y_m;
    std::array<T, kMaxEffectStates> states{};
    std::copy(effects_.initial_states().begin(), effects_.initial_states().end(), states.begin());
    effects_.body.apply(effects_.values(), states.data(), port);
    p_.mass_kg = port.mass_kg;
    p_.yaw_inertia_kg_m2 = port.yaw_inertia_kg_m2;
    p_.center_of_mass_x_m = port.center_of_mass_x_m;
    p_.center_of_mass_y_m = port.center_of_mass_y_m;
  }
  const WheelGeometry<T> g = wheel_geometry(p_);
  if (wheels_ == 1) {
    load_.at_rest_N[0] = p_.mass_kg * kGravity_m_s2;
  } else {
    load_ = wheel_load_law(g, p_.mass_kg, p_.center_of_mass_x_m, p_.center_of_mass_y_m,
                           p_.center_of_mass_height_m);
  }
  const T sx = p_.mass_kg * p_.center_of_mass_x_m, sy = p_.mass_kg * p_.center_of_mass_y_m;
  Eigen::Matrix<T, 3, 3> mass;  // planar_law.h
  mass << p_.mass_kg, T(0), -sy, T(0), p_.mass_kg, sx, -sy, sx, p_.yaw_inertia_kg_m2;
  inverse_mass_ = mass.inverse();
  for (std::size_t i = 0; i < wheels_; ++i) {
    rim_[i] = Vector3(-g.sin_angle[i], g.cos_angle[i], p_.wheel_center_radius_m);
    rim_mobility_[i] = inverse_mass_ * rim_[i];
  }
  for (std::size_t i = 0; i < wheels_; ++i) {
    for (std::size_t j = 0; j < wheels_; ++j) {
      const Vector3 &r = rim_[i], &m = rim_mobility_[j];
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      mobility_cos_(row, column) = r(0) * m(0) + r(1) * m(1);
      mobility_sin_(row, column) = r(0) * m(1) - r(1) * m(0);
      mobility_yaw_(row, column) = r(2) * m(2);
    }
  }
  tyre_.peak = p_.longitudinal.extremum_value;
  tyre_.last = p_.longitudinal.asymptote_value;
  tyre_.last_part = p_.longitudinal.asymptote_slip / p_.longitudinal.extremum_slip;
}

template <typename T>
RollingState<T> RollingRobot<T>::start(const BodyVelocity<double>& v,
                                       const PerWheel<double>& theta_rotor_rad) const {
  RollingState<T> x;
  x.velocity = {T(v.v_forward_m_s), T(v.v_left_m_s), T(v.omega_body_rad_s)};
  x.bus_voltage_V = x.supply_voltage_V = p_.drive.supply_voltage_V;
  x.supply_states = drives_[0].initial_state().effects;
  for (std::size_t i = 0; i < wheels_; ++i) {
    x.drive[i] = drives_[i].initial_state();
    x.theta_rotor_rad[i] = T(theta_rotor_rad[i]);
    x.drive[i].theta_rotor_rad = x.theta_rotor_rad[i];
    const T rim_m_s = rim_[i](0) * x.velocity[0] + rim_[i](1) * x.velocity[1] + rim_[i](2) * x.velocity[2];
    x.drive[i].omega_rotor_rad_s = rim_m_s * p_.drive.gear_ratio / p_.wheel_radius_m;
  }
  return x;
}

template <typename T>
void RollingRobot<T>::set_step(double step_s) {
  for (DriveSim<T>& d : drives_) d.set_step(step_s);
  step_s_ = step_s;
  // wheel_drive.h
  const T settled = p_.drive.torque_constant_Nm_per_A / p_.drive.resistance_ohm;
  mean_sensitivity_ = end_sensitivity_ = settled;
  if (!(value_of(p_.drive.inductance_H) > 0.0)) return;
  using std::exp;
  const T time = step_s * p_.drive.resistance_ohm / p_.drive.inductance_H;
  const T rest = 1.0 - (1.0 - exp(-time)) / time;
  end_sensitivity_ = settled * rest;
  mean_sensitivity_ = settled * (1.0 - 2.0 * rest / time);
}

template <typename T>
void RollingRobot<T>::advance(RollingState<T>& x, const RollingInput<T>& in, double step_s) {
  if (step_s != step_s_) set_step(step_s);
  Step& s = *step_;
  s.h = step_s;
  ask_floor(x, in, s);
  ask_body(x, in, s);
  drives(x, in, s);
  predict(x, in, s);
  solve(x, s);
  if (transfer_load(s)) solve(x, s);
  finish(x, in, s);
}

// ----------------------------------------------------------------------------- what acts, over one step

template <typename T>
void RollingRobot<T>::ask_floor(const RollingState<T>& x, const RollingInput<T>& in, Step& s) const {
  std::array<T, kMaxEffectStates> states;
  const T gear = p_.drive.gear_ratio;
  s.force = Vector3(T(0), T(0), T(0));
  for (std::size_t i = 0; i < wheels_; ++i) {
    Wheel& w = s.wheel[i];
    const T lateral_m_s = rim_[i](1) * x.velocity[0] - rim_[i](0) * x.velocity[1];
    const T hub_m_s = rim_[i](0) * x.velocity[0] + rim_[i](1) * x.velocity[1] + rim_[i](2) * x.velocity[2];
    ContactPort<T> port;
    port.wheel = static_cast<int>(i);
    port.omega_wheel_rad_s = x.omega_rotor_rad_s(i) / gear;
    port.theta_wheel_rad =
        (in.theta_rotor_rad != nullptr ? T((*in.theta_rotor_rad)[i]) : x.theta_rotor_rad[i]) / gear;
    port.v_longitudinal_m_s = hub_m_s;
    port.v_lateral_m_s = lateral_m_s;
    port.load_N = load_N(i, x.floor_x_N, x.floor_y_N);
    port.dt_s = s.h;
    port.wheel_radius_m = p_.wheel_radius_m;
    if (!effects_.contact.empty()) {
      std::copy(effects_.initial_states().begin(), effects_.initial_states().end(), states.begin());
      effects_.contact.apply(effects_.values(), states.data(), port);
    }
    w.lever_m = port.wheel_radius_m / gear;
    w.lateral_N = port.force_lateral_N;
    w.added_torque_Nm = -w.lever_m * port.force_longitudinal_N;
    if (p_.has_tyre) {
      // the floor pushes the wheel, and through it the body
      w.added_N = port.force_longitudinal_N;
      for (Eigen::Index n = 0; n < 3; ++n) s.force(n) += rim_[i](n) * w.added_N;
    }
    w.friction_up_Nm = w.friction_down_Nm = port.friction_wheel_Nm / gear;
    set_grip(x, i, hub_m_s, port, w);
    if (p_.has_lateral_tyre) {
      T scale = absolute(lateral_m_s);
      if (value_of(p_.slip_speed_floor_m_s) > value_of(scale)) scale = p_.slip_speed_floor_m_s;
      w.lateral_N -= grip(p_.lateral, T(lateral_m_s / scale)) * port.load_N;
    }
    s.force(0) += rim_[i](1) * w.lateral_N;
    s.force(1) -= rim_[i](0) * w.lateral_N;
  }
}

template <typename T>
void RollingRobot<T>::set_grip(const RollingState<T>& x, std::size_t i, const T& hub_m_s,
                               const ContactPort<T>& port, Wheel& w) const {
  Grip<T>& g = w.grip;
  g.rolls = !p_.has_tyre && value_of(port.slip_speed_m_s) == 0.0;
  g.load_N = port.load_N;
  g.full_grip_m_s = port.slip_speed_m_s;
  g.shape = tyre_;
  if (p_.has_tyre) {
    const T rim_m_s = absolute(T(w.lever_m * x.omega_rotor_rad_s(i)));
    T scale = absolute(hub_m_s);
    if (value_of(rim_m_s) > value_of(scale)) scale = rim_m_s;
    if (value_of(p_.slip_speed_floor_m_s) > value_of(scale)) scale = p_.slip_speed_floor_m_s;
    g.full_grip_m_s += p_.longitudinal.extremum_slip * scale;
  }
  const double asked = value_of(port.grip_coefficient);
  if (asked > 0.0 && (!p_.has_tyre || asked < value_of(g.shape.peak))) {
    g.shape.last *= port.grip_coefficient / g.shape.peak;
    g.shape.peak = port.grip_coefficient;
  }
}

template <typename T>
void RollingRobot<T>::ask_body(const RollingState<T>& x, const RollingInput<T>& in, Step& s) const {
  const T turn = x.velocity[2] + 0.5 * x.turn_change_rad_s;
  const T turn2 = turn * turn;
  s.force(0) += p_.mass_kg * turn2 * p_.center_of_mass_x_m;
  s.force(1) += p_.mass_kg * turn2 * p_.center_of_mass_y_m;
  if (effects_.body.empty()) return;
  BodyPort<T> port;
  port.v_forward_m_s = x.velocity[0];
  port.v_left_m_s = x.velocity[1];
  port.omega_body_rad_s = x.velocity[2];
  port.yaw_rad = x.yaw_rad;
  port.dribbler_rad_s = T(in.dribbler_rad_s);
  port.dt_s = s.h;
  port.mass_kg = p_.mass_kg;
  port.yaw_inertia_kg_m2 = p_.yaw_inertia_kg_m2;
  port.center_of_mass_x_m = p_.center_of_mass_x_m;
  port.center_of_mass_y_m = p_.center_of_mass_y_m;
  std::array<T, kMaxEffectStates> states;
  std::copy(effects_.initial_states().begin(), effects_.initial_states().end(), states.begin());
  effects_.body.apply(effects_.values(), states.data(), port);
  s.force(0) += port.force_x_N;
  s.force(1) += port.force_y_N;
  s.force(2) += port.torque_z_Nm;
}

// Sensitivity of the winding's current to a departure from the predicted speed, if a voltage is held: wheel_drive.h.
template <typename T>
void RollingRobot<T>::winding_speed_sensitivity(bool enabled, const Link& link, const DriveState<T>& state,
                                                Wheel& w) const {
  w.slope = p_.drive.viscous_friction_Nm_s_per_rad;
  w.mean_sensitivity = w.end_sensitivity = T(0);
  const double used = std::abs(value_of(state.current_A)) * value_of(link.inverse_limit_per_A);
  if (!enabled || used >= 1.0 - 1e-9) return;
  w.end_sensitivity = end_sensitivity_;
  w.mean_sensitivity = mean_sensitivity_;
  w.slope += p_.drive.torque_constant_Nm_per_A * w.mean_sensitivity;
}

// The drives, each against the floor's force and the friction of the step before.
template <typename T>
void RollingRobot<T>::drives(RollingState<T>& x, const RollingInput<T>& in, Step& s) {
  PerWheel<T> bus_A;
  T all_A = T(0);
  const bool shared = !in.bus_is_measured && !effects_.supply.empty();
  for (std::size_t i = 0; i < wheels_; ++i) {
    const T& limit = p_.drive.duty_limit_ratio;
    T duty = in.duty_ratio[i];
    if (value_of(absolute(duty)) > value_of(limit)) duty = value_of(duty) < 0.0 ? T(-limit) : limit;
    bus_A[i] = shared && in.enabled[i] ? T(duty * x.drive[i].current_A) : T(0);
    all_A += bus_A[i];
  }
  for (std::size_t i = 0; i < wheels_; ++i) {
    Wheel& w = s.wheel[i];
    DriveState<T>& state = x.drive[i];
    if (in.theta_rotor_rad != nullptr) {
      state.corrected_rad += (*in.theta_rotor_rad)[i] - state.theta_rotor_rad;
      state.theta_rotor_rad = T((*in.theta_rotor_rad)[i]);
    }
    w.omega_start = state.omega_rotor_rad_s;
    DriveInput<T> drive;
    drive.kind = CommandKind::kDuty;
    drive.enabled = in.enabled[i];
    drive.setpoint = in.duty_ratio[i];
    drive.bus_voltage_V = in.bus_voltage_V;
    drive.bus_is_measured = in.bus_is_measured;
    drive.other_bus_current_A = all_A - bus_A[i];
    drive.tau_outside_Nm = w.added_torque_Nm - w.lever_m * x.force_N[i] - x.friction_Nm[i];
    drive.wheel = static_cast<int>(i);
    w.drive = drives_[i].advance(state, drive, 1);
    const Link& link = *links_[i];
    w.friction_up_Nm += link.friction_positive_Nm;
    w.friction_down_Nm += link.friction_negative_Nm;
    w.omega_predicted = state.omega_rotor_rad_s;
    winding_speed_sensitivity(in.enabled[i], link, state, w);
    w.effective_inertia = inertia_at_rotor(p_.drive) + 0.5 * s.h * w.slope;
    w.speed_per_torque = s.h / w.effective_inertia;
    w.friction_up_rad_s = w.speed_per_torque * w.friction_up_Nm;
    w.friction_down_rad_s = w.speed_per_torque * w.friction_down_Nm;
  }
}

template class RollingRobot<double>;
template class RollingRobot<Jet>;

}  // namespace omnihil
