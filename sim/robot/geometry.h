// Eq. (5): wheel speeds of a body velocity and back, for any four wheel angles.
//
//   WheelGeometry<double> g = wheel_geometry(model);
//   auto omega_wheel_rad_s = wheel_speeds(g, {.v_forward_m_s = 1, .v_left_m_s = 0, .omega_body_rad_s = 0});
//   BodyVelocity<double> v = body_velocity(g, omega_wheel_rad_s);   // least squares
//
// Law:  omega_wheel_i = (1/r) (-sin(a_i) v_forward + cos(a_i) v_left + R_b omega_body)
//       a_i  angle of wheel i from body x (forward) towards y (left);  r  wheel radius;
//       R_b  distance from the geometric centre to the wheel's contact.
// Source: Bakhshandeh and Sharbafi 2012, eq. (5). As printed the right side has no wheel radius, so that its
// left side would be rim speeds in m/s, and its R, declared "the radius of the wheel" under eq. (6), stands
// where the mounting radius R_b belongs; one angle theta also serves all wheels. Here both radii and four
// angles are written out. Frames and numbering: docs/frames-and-wheels.md. Cannot represent: slip (the law
// says what wheels that roll without slip would do) and wheels whose axles do not meet in the geometric
// centre.
#pragma once
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "sim/robot/robot_model.h"

namespace omnihil {

template <typename T>
struct WheelGeometry {
  std::array<T, kWheels> cos_angle{};
  std::array<T, kWheels> sin_angle{};
  T wheel_center_radius_m{};  // R_b
  T wheel_radius_m{};         // r
};

// Of the geometric centre, in the body frame.
template <typename T>
struct BodyVelocity {
  T v_forward_m_s{};
  T v_left_m_s{};
  T omega_body_rad_s{};
};

inline WheelGeometry<double> wheel_geometry(const RobotModel& model) {
  WheelGeometry<double> g;
  for (std::size_t i = 0; i < kWheels; ++i) {
    g.cos_angle[i] = std::cos(model.wheel_angle_rad[i]);
    g.sin_angle[i] = std::sin(model.wheel_angle_rad[i]);
  }
  g.wheel_center_radius_m = model.wheel_center_radius_m;
  g.wheel_radius_m = model.wheel_radius_m;
  return g;
}

// Speed of the robot's body over the floor above wheel i, along the wheel's drive direction.
template <typename T>
T rim_speed_m_s(const WheelGeometry<T>& g, std::size_t i, const BodyVelocity<T>& v) {
  return -g.sin_angle[i] * v.v_forward_m_s + g.cos_angle[i] * v.v_left_m_s +
         g.wheel_center_radius_m * v.omega_body_rad_s;
}

// The same across the drive direction, outward: what the rollers take up.
template <typename T>
T roller_speed_m_s(const WheelGeometry<T>& g, std::size_t i, const BodyVelocity<T>& v) {
  return g.cos_angle[i] * v.v_forward_m_s + g.sin_angle[i] * v.v_left_m_s;
}

// Eq. (5), corrected.
template <typename T>
std::array<T, kWheels> wheel_speeds(const WheelGeometry<T>& g, const BodyVelocity<T>& v) {
  std::array<T, kWheels> omega_wheel_rad_s;
  for (std::size_t i = 0; i < kWheels; ++i) omega_wheel_rad_s[i] = rim_speed_m_s(g, i, v) / g.wheel_radius_m;
  return omega_wheel_rad_s;
}

// Rows (-sin a_i, cos a_i, R_b): rim speeds of a body velocity. Rank 3 unless all four axles are parallel
// or R_b is zero.
template <typename T>
Eigen::Matrix<T, kWheels, 3> rim_matrix(const WheelGeometry<T>& g) {
  Eigen::Matrix<T, kWheels, 3> m;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    m(row, 0) = -g.sin_angle[i];
    m(row, 1) = g.cos_angle[i];
    m(row, 2) = g.wheel_center_radius_m;
  }
  return m;
}

// The body velocity whose rim speeds come closest to the wheels' (least squares; four equations for three).
template <typename T>
BodyVelocity<T> body_velocity(const WheelGeometry<T>& g, const std::array<T, kWheels>& omega_wheel_rad_s) {
  const Eigen::Matrix<T, kWheels, 3> m = rim_matrix(g);
  Eigen::Matrix<T, kWheels, 1> rim;
  for (std::size_t i = 0; i < kWheels; ++i) {
    rim(static_cast<Eigen::Index>(i)) = g.wheel_radius_m * omega_wheel_rad_s[i];
  }
  const Eigen::Matrix<T, 3, 3> normal = m.transpose() * m;
  const Eigen::Matrix<T, 3, 1> right = m.transpose() * rim;
  const Eigen::Matrix<T, 3, 1> v = normal.inverse() * right;
  return {v(0), v(1), v(2)};
}

}  // namespace omnihil
