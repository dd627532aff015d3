// What a mechanics back end is: it turns positions, speeds and held rotor torques of all robots into
// accelerations. PlanarMechanics and Chassis (Simbody) are the two; integrate.h and the plant are written
// once over either.
//
//   back.set_state(q, u);                    // all robots, one after another
//   back.contacts(robot);                    // floor forces at that state
//   back.accelerations(torques, part, udot); // at that state, with these torques at that part of the step
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

// Where in a mechanical step a torque is wanted. kHeld: its mean, for integrators that look once per step.
enum class StepPart : std::size_t { kStart = 0, kMiddle = 1, kEnd = 2, kHeld = 3 };

// What the winding and Coulomb friction do to one rotor through one mechanical step:
//   torque = torque_Nm[part] - slope (omega_rotor - omega_rad_s[part])
// The slope is the winding's sensitivity to a departure from the predicted speed. Viscous friction is the back
// end's.
struct WheelTorque {
  std::array<double, 4> torque_Nm{};    // by StepPart; start, middle and end make the mean by Simpson's rule
  std::array<double, 4> omega_rad_s{};  // of the rotor, as the winding's solution predicts it
  double slope_Nm_s_per_rad = 0.0;
  bool locked = false;  // static friction holds this wheel at zero speed: no acceleration

  double at(StepPart part, double omega_rotor_rad_s) const {
    const auto n = static_cast<std::size_t>(part);
    return torque_Nm[n] - slope_Nm_s_per_rad * (omega_rotor_rad_s - omega_rad_s[n]);
  }
};
using WheelTorques = std::array<WheelTorque, kWheels>;  // of one robot

struct BodyMotion {
  double x_m = 0, y_m = 0, yaw_rad = 0;
  BodyVelocity<double> velocity;
};

}  // namespace omnihil
