// What a mechanics back end is: it turns positions, speeds and held rotor torques of all robots into
// accelerations. PlanarMechanics and Chassis (Simbody) are the two; integrate.h and the plant are written
// once over either.
//
//   back.set_state(q, u);                    // all robots, one after another
//   back.contacts(robot);                    // floor forces at that state
//   back.accelerations(torques, part, udot); // at that state, with these torques at that part of the step
//   back.position_rates(q, u, qdot);         // dq/dt = N(q) u, for any q and u; kRatesAreSpeeds: N = 1
//
// State of one robot: q = (pose, wheel angles), u = (body speeds, wheel speeds); as many wheels as the robot with the
// most has, so that all robots take the same room.
//   planar joint:  pose yaw, x, y;                     speeds yaw rate, v_x, v_y in the field frame W
//   free body:     pose quaternion (w, x, y, z), x, y, z; speeds omega_W, v_W
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "sim/robot/contact.h"

namespace omnihil {

struct StateLayout {
  std::size_t q_per_robot = 0;
  std::size_t u_per_robot = 0;
  std::size_t wheel_q = 0;  // index of the first wheel's angle within a robot's q
  std::size_t wheel_u = 0;
};

constexpr StateLayout planar_layout(std::size_t wheels) { return {3 + wheels, 3 + wheels, 3, 3}; }
constexpr StateLayout free_layout(std::size_t wheels) { return {7 + wheels, 6 + wheels, 7, 6}; }

inline std::size_t most_wheels(const std::vector<RobotModel>& robots) {
  std::size_t most = 0;
  for (const RobotModel& m : robots) most = m.wheels > most ? m.wheels : most;
  return most;
}

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
using WheelTorques = PerWheel<WheelTorque>;  // of one robot

// Of the body's x axis in the field frame.
struct Heading {
  double cos_yaw = 1.0, sin_yaw = 0.0;
};
inline Heading heading_of(double yaw_rad) {
  Heading to;
  ::sincos(yaw_rad, &to.sin_yaw, &to.cos_yaw);  // the same bits as sin and cos, at the cost of one
  return to;
}

struct BodyMotion {
  double x_m = 0, y_m = 0, yaw_rad = 0;
  BodyVelocity<double> velocity;
};

}  // namespace omnihil
