#include "sim/robot/planar.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

// Field-frame speeds (yaw rate, v_x, v_y) as the body sees them.
BodyVelocity<double> in_body(const double* u, const Heading& to) {
  return {.v_forward_m_s = to.cos_yaw * u[1] + to.sin_yaw * u[2],
          .v_left_m_s = -to.sin_yaw * u[1] + to.cos_yaw * u[2],
          .omega_body_rad_s = u[0]};
}

}  // namespace

PlanarMechanics::PlanarMechanics(const std::vector<RobotModel>& robots,
                                 const std::vector<const FloorEffects*>& effects)
    : layout_(planar_layout(most_wheels(robots))), u_(robots.size() * layout_.u_per_robot) {
  for (const RobotModel& m : robots) {
    Robot r;
    r.law = contact_law(m);
    r.body = planar_body(m);
    r.gear_ratio = m.gear_ratio;
    r.wheel_viscous_Nm_s_per_rad = m.gear_ratio * m.gear_ratio * m.motor.viscous_friction_Nm_s_per_rad;
    if (!effects.empty()) r.effects = effects[robots_.size()];
    robots_.push_back(r);
  }
}

// A step begins where the one before was looked at.
[[gnu::always_inline]] inline const Heading& PlanarMechanics::look_along(Robot& r, double yaw_rad) {
  if (!is_looked_at(r, yaw_rad)) {
    r.yaw_rad = yaw_rad;
    r.heading = heading_of(yaw_rad);
  }
  return r.heading;
}

const Heading& PlanarMechanics::heading(const std::vector<double>& q, std::size_t robot) {
  return look_along(robots_[robot], q[robot * layout_.q_per_robot]);
}

PerWheel<double> PlanarMechanics::wheels_of(const Robot& r, const double* first) {
  PerWheel<double> out{};
  each_wheel(r.law.geometry.wheels, [&](std::size_t i) { out[i] = first[i]; });
  return out;
}

[[gnu::flatten]] void PlanarMechanics::set_state(const std::vector<double>& q, const std::vector<double>& u) {
  std::ranges::copy(u, u_.begin());
  for (std::size_t n = 0; n < robots_.size(); ++n) {
    Robot& r = robots_[n];
    const double* qr = q.data() + n * layout_.q_per_robot;
    const double* ur = u.data() + n * layout_.u_per_robot;
    r.omega_body_rad_s = ur[0];
    const BodyVelocity<double> velocity = in_body(ur, look_along(r, qr[0]));
    const PerWheel<double> omega_wheel = wheels_of(r, ur + layout_.wheel_u);
    const WheelMotion<double> motion = wheel_motion(r.law, velocity, omega_wheel);
    if (r.effects == nullptr) {
      find_contacts(r.law, motion, r.contacts);
    } else {
      const FloorState state{qr[0], velocity, omega_wheel, wheels_of(r, qr + layout_.wheel_q)};
      r.contacts = r.effects->contacts(r.law, motion, state, nullptr, r.more);
    }
    lift_wheels(r.law, r.lifted, r.contacts);
  }
}

void PlanarMechanics::accelerations(const std::vector<WheelTorques>& torques, StepPart part,
                                    std::vector<double>& udot) {
  for (std::size_t n = 0; n < robots_.size(); ++n) {
    const Robot& r = robots_[n];
    const WheelContacts<double>& c = r.contacts;
    const bool more = r.effects != nullptr;
    const auto a =
        more ? body_acceleration(r.body, c.force_x_N + r.more.body_force_x_N,
                                 c.force_y_N + r.more.body_force_y_N, c.moment_z_Nm + r.more.body_moment_z_Nm,
                                 r.omega_body_rad_s)
             : body_acceleration(r.body, c.force_x_N, c.force_y_N, c.moment_z_Nm, r.omega_body_rad_s);
    double* out = udot.data() + n * layout_.u_per_robot;
    out[0] = a.yaw_rad_s2;
    out[1] = r.heading.cos_yaw * a.x_m_s2 - r.heading.sin_yaw * a.y_m_s2;
    out[2] = r.heading.sin_yaw * a.x_m_s2 + r.heading.cos_yaw * a.y_m_s2;
    const double* omega_wheel = u_.data() + n * layout_.u_per_robot + layout_.wheel_u;
    each_wheel(r.law.geometry.wheels, [&](std::size_t i) {
      const double radius_m = more ? r.more.wheel_radius_m[i] : r.law.geometry.wheel_radius_m;
      // J domega/dt = gear tau_rotor - gear^2 b omega - r F
      const double torque_Nm = r.gear_ratio * torques[n][i].at(part, r.gear_ratio * omega_wheel[i]) -
                               r.wheel_viscous_Nm_s_per_rad * omega_wheel[i] -
                               radius_m * c.force_longitudinal_N[i];
      out[layout_.wheel_u + i] = torques[n][i].locked ? 0.0 : torque_Nm * r.body.inverse_spin_inertia;
    });
  }
}

void PlanarMechanics::position_rates(const std::vector<double>&, const std::vector<double>& u,
                                     std::vector<double>& qdot) const {
  std::ranges::copy(u, qdot.begin());
}

BodyMotion PlanarMechanics::motion(const std::vector<double>& q, const std::vector<double>& u,
                                   std::size_t robot) const {
  const double* qr = q.data() + robot * layout_.q_per_robot;
  const double* ur = u.data() + robot * layout_.u_per_robot;
  const Robot& r = robots_[robot];
  const Heading to = is_looked_at(r, qr[0]) ? r.heading : heading_of(qr[0]);
  return {.x_m = qr[1], .y_m = qr[2], .yaw_rad = qr[0], .velocity = in_body(ur, to)};
}

void PlanarMechanics::place(std::vector<double>& q, std::vector<double>& u, std::size_t robot, double x_m,
                            double y_m, double yaw_rad) const {
  double* qr = q.data() + robot * layout_.q_per_robot;
  std::fill_n(qr, layout_.q_per_robot, 0.0);
  std::fill_n(u.data() + robot * layout_.u_per_robot, layout_.u_per_robot, 0.0);
  qr[0] = yaw_rad;
  qr[1] = x_m;
  qr[2] = y_m;
}

}  // namespace omnihil
