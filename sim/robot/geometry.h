// Eq. (5): wheel speeds of a body velocity and back, for any two to six wheel angles.
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
#include <cmath>
#include <type_traits>

#include "sim/law/scalar.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

// A row of three per wheel. Rows: four, or Eigen::Dynamic for any other number.
template <typename T, int Rows>
using WheelRows = Eigen::Matrix<T, Rows, 3, Eigen::ColMajor,
                                Rows == Eigen::Dynamic ? static_cast<int>(kMaxWheels) : Rows, 3>;

// f(std::integral_constant<int, Rows>()): of four wheels with their number known.
template <typename F>
decltype(auto) with_wheel_rows(std::size_t count, F&& f) {
  if (count == 4) return f(std::integral_constant<int, 4>());
  return f(std::integral_constant<int, Eigen::Dynamic>());
}

template <typename T>
struct WheelGeometry {
  std::size_t wheels = kWheels;
  PerWheel<T> cos_angle{};
  PerWheel<T> sin_angle{};
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
  g.wheels = model.wheels;
  for (std::size_t i = 0; i < g.wheels; ++i) {
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
PerWheel<T> wheel_speeds(const WheelGeometry<T>& g, const BodyVelocity<T>& v) {
  PerWheel<T> omega_wheel_rad_s{};
  for (std::size_t i = 0; i < g.wheels; ++i) omega_wheel_rad_s[i] = rim_speed_m_s(g, i, v) / g.wheel_radius_m;
  return omega_wheel_rad_s;
}

// Rows (-sin a_i, cos a_i, R_b): rim speeds of a body velocity. Rank 3 unless all axles are parallel (rank 2: a
// differential drive) or R_b is zero. Rows: four, or Eigen::Dynamic for any number.
template <int Rows, typename T>
WheelRows<T, Rows> rim_matrix_of(const WheelGeometry<T>& g) {
  WheelRows<T, Rows> m(static_cast<Eigen::Index>(g.wheels), 3);
  for (std::size_t i = 0; i < g.wheels; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    m(row, 0) = -g.sin_angle[i];
    m(row, 1) = g.cos_angle[i];
    m(row, 2) = g.wheel_center_radius_m;
  }
  return m;
}
template <typename T>
WheelRows<T, Eigen::Dynamic> rim_matrix(const WheelGeometry<T>& g) {
  return rim_matrix_of<Eigen::Dynamic>(g);
}

// All axles lie on one line through the centre: these wheels ask for nothing along it, and carry nothing across it.
template <typename T>
bool axles_are_parallel(const WheelGeometry<T>& g) {
  // sine of 1/20 degree: no wheel is mounted truer
  constexpr double kParallel = 1e-3;
  for (std::size_t i = 1; i < g.wheels; ++i) {
    const double across = value_of(g.sin_angle[i]) * value_of(g.cos_angle[0]) -
                          value_of(g.cos_angle[i]) * value_of(g.sin_angle[0]);
    if (std::abs(across) > kParallel) return false;
  }
  return true;
}

// The inverse of `normal`; where the unit vector (x, y) of its rows `first` and on lies in its kernel, the pseudo-inverse:
// A+ = (A + n n')^-1 - n n'.
template <typename T>
Eigen::Matrix<T, 3, 3> inverse_without(const Eigen::Matrix<T, 3, 3>& normal, Eigen::Index first, const T& x,
                                       const T& y) {
  Eigen::Matrix<T, 3, 1> n = Eigen::Matrix<T, 3, 1>::Zero();
  n(first) = x;
  n(first + 1) = y;
  const Eigen::Matrix<T, 3, 3> kernel = n * n.transpose();
  const Eigen::Matrix<T, 3, 3> full = normal + kernel;
  return full.inverse() - kernel;
}

// The body velocity whose rim speeds come closest to the wheels' (least squares); nothing along axles that are all
// parallel.
template <typename T>
BodyVelocity<T> body_velocity(const WheelGeometry<T>& g, const PerWheel<T>& omega_wheel_rad_s) {
  return with_wheel_rows(g.wheels, [&](auto rows) {
    const auto m = rim_matrix_of<rows()>(g);
    Eigen::Matrix<T, decltype(m)::RowsAtCompileTime, 1, 0, decltype(m)::MaxRowsAtCompileTime, 1> rim(
        m.rows());
    for (std::size_t i = 0; i < g.wheels; ++i) {
      rim(static_cast<Eigen::Index>(i)) = g.wheel_radius_m * omega_wheel_rad_s[i];
    }
    const Eigen::Matrix<T, 3, 3> normal = m.transpose() * m;
    const Eigen::Matrix<T, 3, 1> right = m.transpose() * rim;
    const Eigen::Matrix<T, 3, 3> inverse = axles_are_parallel(g)
                                               ? inverse_without<T>(normal, 0, g.cos_angle[0], g.sin_angle[0])
                                               : Eigen::Matrix<T, 3, 3>(normal.inverse());
    const Eigen::Matrix<T, 3, 1> v = inverse * right;
    return BodyVelocity<T>{v(0), v(1), v(2)};
  });
}

}  // namespace omnihil
