// A robot taken apart into rigid bodies, as multibody programs want it: a base and its wheels.
//
//   const RigidBodies b = rigid_bodies(*model.robot);
//   b.base_mass_kg;  b.base_com_m;  b.wheel_position_m[2];
//
// Law: what is left of the whole robot's mass, centre of mass and yaw inertia when the wheels are taken off (sum of masses,
// of first moments, parallel axes). The model is planar: inertias about horizontal axes are not in it and are assumed, those of the
// base as a cylinder of twice the height of its centre of mass, I = I_zz / 2 + m (2 h)^2 / 12; of a wheel as a disc of
// half its radius' width, J / 2 + m w^2 / 12.
// Axes: x forward, y left, z up, origin on the floor below the geometric centre.
#pragma once
#include <Eigen/Core>
#include <string>

#include "sim/robot/robot_model.h"

namespace omnihil {

inline constexpr double kWheelWidth_ratio = 0.5;  // of the wheel's radius: a usual one, the model has none

struct RigidBodies {
  double base_mass_kg = 0.0;
  Eigen::Vector3d base_com_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d base_inertia_kg_m2 = Eigen::Vector3d::Zero();  // xx, yy, zz about its centre of mass
  double wheel_inertia_axle_kg_m2 = 0.0, wheel_inertia_across_kg_m2 = 0.0;
  PerWheel<Eigen::Vector3d> wheel_position_m;
  PerWheel<Eigen::Vector3d> wheel_axis;  // positive turns drive the rim along the counter-clockwise tangent
  std::string problem;                   // not empty: nothing is left for the base
};

RigidBodies rigid_bodies(const RobotModel& model);

}  // namespace omnihil
