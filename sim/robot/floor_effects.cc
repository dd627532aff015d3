#include "sim/robot/floor_effects.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/law/effect_set.h"

namespace omnihil {
namespace {

using States = std::array<double, kMaxEffectStates>;

// Floor and body have no memory: what asks for some finds its initial values, every time.
States states_of(const EffectSet<double>& effects) {
  States states{};
  std::copy(effects.initial_states().begin(), effects.initial_states().end(), states.begin());
  return states;
}

// slip with the sliding speed that full grip takes on top of the tyre's own
double softened_slip(const WheelMotion<double>& m, std::size_t i, double floor_m_s, double slip_speed_m_s,
                     double extremum_slip) {
  const double scale_m_s =
      std::max({std::abs(m.drive_speed_m_s[i]), std::abs(m.rim_speed_m_s[i]), floor_m_s});
  return (m.drive_speed_m_s[i] - m.rim_speed_m_s[i]) / (scale_m_s + slip_speed_m_s / extremum_slip);
}

TyreCurve limited(TyreCurve curve, double grip) {
  if (grip <= 0.0 || grip >= curve.extremum_value) return curve;
  curve.asymptote_value *= grip / curve.extremum_value;
  curve.extremum_value = grip;
  return curve;
}

}  // namespace

struct FloorEffects::Wheel {
  double radius_m, slip_speed_m_s, grip, force_longitudinal_N, force_lateral_N, friction_Nm;
};

RobotModel robot_with_effects(const RobotModel& model, const EffectSet<double>& effects) {
  RobotModel out = model;
  if (effects.body.empty()) return out;
  BodyPort<double> port;
  port.mass_kg = model.mass_kg;
  port.yaw_inertia_kg_m2 = model.yaw_inertia_kg_m2;
  port.center_of_mass_x_m = model.center_of_mass_x_m;
  port.center_of_mass_y_m = model.center_of_mass_y_m;
  States states = states_of(effects);
  effects.body.apply(effects.values(), states.data(), port);
  out.mass_kg = port.mass_kg;
  out.yaw_inertia_kg_m2 = port.yaw_inertia_kg_m2;
  out.center_of_mass_x_m = port.center_of_mass_x_m;
  out.center_of_mass_y_m = port.center_of_mass_y_m;
  return out;
}

FloorEffects::FloorEffects(std::shared_ptr<const EffectSet<double>> effects, const RobotModel& model,
                           double step_s)
    : effects_(std::move(effects)),
      wheel_radius_m_(model.wheel_radius_m),
      mass_kg_(model.mass_kg),
      yaw_inertia_kg_m2_(model.yaw_inertia_kg_m2),
      com_x_m_(model.center_of_mass_x_m),
      com_y_m_(model.center_of_mass_y_m),
      step_s_(step_s) {}

FloorEffects::Wheel FloorEffects::ask(std::size_t wheel, const WheelMotion<double>& motion,
                                      const FloorState& state, double load_N) const {
  ContactPort<double> port;
  port.wheel = static_cast<int>(wheel);
  port.omega_wheel_rad_s = state.omega_wheel_rad_s[wheel];
  port.theta_wheel_rad = state.theta_wheel_rad[wheel];
  port.v_longitudinal_m_s = motion.drive_speed_m_s[wheel];
  port.v_lateral_m_s = motion.roller_speed_m_s[wheel];
  port.load_N = load_N;
  port.dt_s = step_s_;
  port.wheel_radius_m = wheel_radius_m_;
  States states = states_of(*effects_);
  effects_->contact.apply(effects_->values(), states.data(), port);
  return {port.wheel_radius_m,       port.slip_speed_m_s,  port.grip_coefficient,
          port.force_longitudinal_N, port.force_lateral_N, port.friction_wheel_Nm};
}

void FloorEffects::ask_body(const FloorState& state, FloorForces& more) const {
  more.body_force_x_N = more.body_force_y_N = more.body_moment_z_Nm = 0.0;
  if (effects_->body.empty()) return;
  BodyPort<double> port;
  port.v_forward_m_s = state.velocity.v_forward_m_s;
  port.v_left_m_s = state.velocity.v_left_m_s;
  port.omega_body_rad_s = state.velocity.omega_body_rad_s;
  port.yaw_rad = state.yaw_rad;
  port.dribbler_rad_s = dribbler_rad_s;
  port.dt_s = step_s_;
  port.mass_kg = mass_kg_;
  port.yaw_inertia_kg_m2 = yaw_inertia_kg_m2_;
  port.center_of_mass_x_m = com_x_m_;
  port.center_of_mass_y_m = com_y_m_;
  States states = states_of(*effects_);
  effects_->body.apply(effects_->values(), states.data(), port);
  more.body_force_x_N = port.force_x_N;
  more.body_force_y_N = port.force_y_N;
  more.body_moment_z_Nm = port.torque_z_Nm;
}

WheelContacts<double> FloorEffects::contacts(const ContactLaw<double>& law, const WheelMotion<double>& motion,
                                             const FloorState& state, const PerWheel<double>* load_N,
                                             FloorForces& more) const {
  ask_body(state, more);
  if (effects_->contact.empty()) {
    more.wheel_radius_m.fill(wheel_radius_m_);
    more.friction_wheel_Nm.fill(0.0);
    return load_N != nullptr ? contact_forces_at(law, motion, *load_N) : contact_forces(law, motion);
  }
  WheelContacts<double> out;
  WheelGrip<double> g;
  WheelMotion<double> m = motion;
  PerWheel<Wheel> wheels{};
  const auto drive_force = [&](std::size_t i, double& x_N, double& y_N) {
    const Wheel& w = wheels[i];
    x_N +=
        -law.geometry.sin_angle[i] * w.force_longitudinal_N + law.geometry.cos_angle[i] * w.force_lateral_N;
    y_N += law.geometry.cos_angle[i] * w.force_longitudinal_N + law.geometry.sin_angle[i] * w.force_lateral_N;
  };
  double added_x_N = 0.0, added_y_N = 0.0;
  for (std::size_t i = 0; i < law.geometry.wheels; ++i) {
    const Wheel& w = wheels[i] =
        ask(i, motion, state, load_N != nullptr ? (*load_N)[i] : law.load.at_rest_N[i]);
    m.rim_speed_m_s[i] = w.radius_m * state.omega_wheel_rad_s[i];
    out.slip_longitudinal_ratio[i] =
        slip_ratio(m.drive_speed_m_s[i], m.rim_speed_m_s[i], law.slip_speed_floor_m_s);
    const double slip =
        softened_slip(m, i, law.slip_speed_floor_m_s, w.slip_speed_m_s, law.longitudinal.extremum_slip);
    g.longitudinal_ratio[i] = -grip(limited(law.longitudinal, w.grip), slip);
    g.lateral_ratio[i] = -grip(law.lateral, slip_ratio(m.roller_speed_m_s[i], 0.0, law.slip_speed_floor_m_s));
    drive_force(i, added_x_N, added_y_N);
  }
  if (load_N != nullptr) {
    out.load_N = *load_N;
  } else {
    find_loads(law, g, out, added_x_N, added_y_N);
    for (std::size_t i = 0; i < law.geometry.wheels; ++i) wheels[i] = ask(i, motion, state, out.load_N[i]);
  }
  apply_loads(law, g, out);
  for (std::size_t i = 0; i < law.geometry.wheels; ++i) {
    const Wheel& w = wheels[i];
    more.wheel_radius_m[i] = w.radius_m;
    more.friction_wheel_Nm[i] = w.friction_Nm;
    out.force_longitudinal_N[i] += w.force_longitudinal_N;
    out.force_lateral_N[i] += w.force_lateral_N;
    drive_force(i, out.force_x_N, out.force_y_N);
    out.moment_z_Nm += law.geometry.wheel_center_radius_m * w.force_longitudinal_N;
  }
  return out;
}

}  // namespace omnihil
