// Closed form of one robot on a plane: seven speeds (body x, y, yaw and four wheels) from forces and torques.
//
//   PlanarBody<double> body = planar_body(model);
//   auto a = body_acceleration(body, force_x_N, force_y_N, moment_z_Nm, omega_body_rad_s);
//
// Law (body frame B, geometric centre o, centre of mass c = (c_x, c_y), yaw inertia I about o, wheels
// included):
//   F_x = m (a_x - alpha c_y - w^2 c_x)
//   F_y = m (a_y + alpha c_x - w^2 c_y)
//   M   = I alpha + m (c_x a_y - c_y a_x)
//   J d omega_wheel / dt = tau_wheel - r F_longitudinal,   J = J_wheel + gear^2 J_rotor
// with a the acceleration of o relative to the field, written in B. In B the mass matrix is constant, and the
// axles are horizontal, so that wheel spin and yaw do not couple.
// Source: Newton and Euler for one rigid body; held to Simbody's mass matrix and trajectory by tests/sim.
// Cannot represent: pitch, roll and lift (loads enter quasi-statically), the axial part of a tilted gear
// train.
#pragma once
#include "sim/robot/robot_model.h"

namespace omnihil {

template <typename T>
struct PlanarBody {
  T mass_kg{};
  T com_x_m{}, com_y_m{};
  T inverse_yaw_inertia{};   // 1 / (I - m |c|^2): about the centre of mass
  T inverse_spin_inertia{};  // 1 / J
};

template <typename T>
struct BodyAcceleration {
  T x_m_s2{}, y_m_s2{}, yaw_rad_s2{};
};

// J: what turns with the wheel, at the wheel.
inline double spin_inertia_kg_m2(const RobotModel& model) {
  return model.wheel_inertia_kg_m2 + model.gear_ratio * model.gear_ratio * model.motor.rotor_inertia_kg_m2;
}

inline PlanarBody<double> planar_body(const RobotModel& m) {
  const double offset2_m2 =
      m.center_of_mass_x_m * m.center_of_mass_x_m + m.center_of_mass_y_m * m.center_of_mass_y_m;
  PlanarBody<double> b;
  b.mass_kg = m.mass_kg;
  b.com_x_m = m.center_of_mass_x_m;
  b.com_y_m = m.center_of_mass_y_m;
  b.inverse_yaw_inertia = 1.0 / (m.yaw_inertia_kg_m2 - m.mass_kg * offset2_m2);
  b.inverse_spin_inertia = 1.0 / spin_inertia_kg_m2(m);
  return b;
}

template <typename T>
BodyAcceleration<T> body_acceleration(const PlanarBody<T>& b, const T& force_x_N, const T& force_y_N,
                                      const T& moment_z_Nm, const T& omega_body_rad_s) {
  BodyAcceleration<T> a;
  const T w2 = omega_body_rad_s * omega_body_rad_s;
  // (I - m |c|^2) alpha = M - c_x F_y + c_y F_x
  a.yaw_rad_s2 = (moment_z_Nm - b.com_x_m * force_y_N + b.com_y_m * force_x_N) * b.inverse_yaw_inertia;
  a.x_m_s2 = force_x_N / b.mass_kg + a.yaw_rad_s2 * b.com_y_m + w2 * b.com_x_m;
  a.y_m_s2 = force_y_N / b.mass_kg - a.yaw_rad_s2 * b.com_x_m + w2 * b.com_y_m;
  return a;
}

}  // namespace omnihil
