// What a mechanics back end is: it turns positions, speeds and held rotor torques of all robots into
// accelerations. PlanarMechanics and Chassis (Simbody) are the two; integrate.h and the plant are written
// once over either.
//
//   back.set_state(q, u);                    // all robots, one after another
//   back.contacts(robot);                    // floor forces at that state
//   back.accelerations(torques, udot);       // at that state, with these torques
//   back.position_rates(q, u, qdot);         // dq/dt = N(q) u, for any q and u
//
// State of one robot: q = (pose, wheel angles 0..3), u = (body speeds, wheel speeds 0..3).
//   planar joint:  pose yaw, x, y;                     speeds yaw rate, v_x, v_y in the field frame W
//   free body:     pose quaternion (w, x, y, z), x, y, z; speeds omega_W, v_W
#pragma once
#include <array>
#include <cstddef>

#include "sim/robot/contact.h"

namespace omnihil {

struct StateLayout {
  std::size_t q_per_robot = 0;
  std::size_t u_per_robot = 0;
  std::size_t wheel_q = 0;  // index of the first wheel's angle within a robot's q
  std::size_t wheel_u = 0;
};

inline constexpr StateLayout kPlanarLayout{7, 7, 3, 3};
inline constexpr StateLayout kFreeLayout{11, 10, 7, 6};

// Held through one mechanical step.
struct WheelTorques {
  std::array<double, kWheels> rotor_Nm{};  // winding and Coulomb friction; viscous friction is the back end's
  std::array<bool, kWheels> locked{};      // static friction holds this wheel at zero speed: no acceleration
};

struct BodyMotion {
  double x_m = 0, y_m = 0, yaw_rad = 0;
  BodyVelocity<double> velocity;
};

}  // namespace omnihil
