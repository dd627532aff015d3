// How the robot's weight stands on its wheels, at rest and while it accelerates.
//
//   WheelLoadLaw<double> law = wheel_load_law(geometry, mass_kg, com_x_m, com_y_m, com_height_m);
//   law.at_rest_N[i];                                   // sums to m g
//   law.transfer(i, force_x_N, force_y_N);              // change by the floor's horizontal force on the robot
//
// Law: three balances (vertical force, moments about x and y through the geometric centre),
//        sum N_i = m g,   sum N_i x_i = m g c_x - h F_x,   sum N_i y_i = m g c_y - h F_y,
//      and, as more than three unknowns need more, a rigid chassis on equal springs: N_i = A + B x_i + C y_i.
//      Wheels on one line (a differential drive) hold no moment along their drive direction: a caster without friction
//      and load does.
//      F is the whole horizontal force of the floor; it equals mass times the acceleration of the centre of
//      mass, so this is the quasi-static load transfer without asking for an acceleration first.
// Source: statics of a rigid body; equal compliance is our choice (the free-body model has the same springs).
// Cannot represent: a lifted wheel (loads below zero: contact.h limits the transfer), pitch and roll
// dynamics, the reaction of wheels and rotors that spin up, an uneven floor.
#pragma once
#include <Eigen/LU>

#include "sim/contact/gravity.h"
#include "sim/robot/geometry.h"

namespace omnihil {

template <typename T>
struct WheelLoadLaw {
  PerWheel<T> at_rest_N{};
  PerWheel<T> per_force_x_ratio{};  // dN_i / dF_x
  PerWheel<T> per_force_y_ratio{};

  T transfer(std::size_t i, const T& force_x_N, const T& force_y_N) const {
    return per_force_x_ratio[i] * force_x_N + per_force_y_ratio[i] * force_y_N;
  }
};

template <typename T>
WheelLoadLaw<T> wheel_load_law(const WheelGeometry<T>& g, const T& mass_kg, const T& com_x_m,
                               const T& com_y_m, const T& com_height_m) {
  return with_wheel_rows(g.wheels, [&](auto rows) {
    WheelRows<T, rows()> place(static_cast<Eigen::Index>(g.wheels), 3);  // rows (1, x_i, y_i)
    for (std::size_t i = 0; i < g.wheels; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      place(row, 0) = T(1);
      place(row, 1) = g.wheel_center_radius_m * g.cos_angle[i];
      place(row, 2) = g.wheel_center_radius_m * g.sin_angle[i];
    }
    // N = place (place' place)^-1 (m g, m g c_x - h F_x, m g c_y - h F_y)
    const Eigen::Matrix<T, 3, 3> normal = place.transpose() * place;
    const Eigen::Matrix<T, 3, 3> inverse =
        axles_are_parallel(g) ? inverse_without<T>(normal, 1, T(-g.sin_angle[0]), g.cos_angle[0])
                              : Eigen::Matrix<T, 3, 3>(normal.inverse());
    const WheelRows<T, rows()> share = place * inverse;
    const T weight_N = mass_kg * kGravity_m_s2;
    WheelLoadLaw<T> law;
    for (std::size_t i = 0; i < g.wheels; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      law.at_rest_N[i] = weight_N * (share(row, 0) + share(row, 1) * com_x_m + share(row, 2) * com_y_m);
      law.per_force_x_ratio[i] = -com_height_m * share(row, 1);
      law.per_force_y_ratio[i] = -com_height_m * share(row, 2);
    }
    return law;
  });
}

}  // namespace omnihil
