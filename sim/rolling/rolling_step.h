// What acts over one step of a robot that rolls (rolling_robot.h), and what comes of it. For rolling_*.cc alone.
#pragma once
#include "sim/rolling/rolling_robot.h"

namespace omnihil {

template <typename T>
struct RollingRobot<T>::Wheel {
  DriveResult<T> drive;
  T omega_start = T(0), omega_predicted = T(0);
  T effective_inertia = T(0), slope = T(0), end_sensitivity = T(0), mean_sensitivity = T(0);
  T speed_per_torque = T(0);                               // h / J_e
  T friction_up_rad_s = T(0), friction_down_rad_s = T(0);  // that friction may take off the rotor's speed
  T lever_m = T(0);                                        // radius over gear
  T friction_up_Nm = T(0), friction_down_Nm = T(0);
  T added_torque_Nm = T(0);  // at the rotor, by forces of effects along the drive direction
  T added_N = T(0);          // the same forces on the body: none on wheels that roll
  T lateral_N = T(0);
  T hub_free_m_s = T(0);  // rim speed of the body without this step's floor forces
  Grip<T> grip;
  T end_share = T(1);  // of the floor force at the step's end in its mean over the step
};

template <typename T>
struct RollingRobot<T>::Step {
  double h = 0.0;
  PerWheel<Wheel> wheel;
  Vector3 force;  // of effects and of turning, on the body
  T cos_half = T(1), sin_half = T(0);
  Vector3 turned, free;  // velocity carried into the end's frame; the same with `force`
  Eigen::Matrix<T, kMaxWheels, kMaxWheels> mobility;  // h G M^-1 G': rim speeds per floor force
  PerWheel<T> end_force_N;                            // of the floor, at the step's end

  // By half a step's turn, into the frame of the step's end.
  Vector3 half_turned(const Vector3& v) const {
    return Vector3(cos_half * v(0) + sin_half * v(1), cos_half * v(1) - sin_half * v(0), v(2));
  }
};

}  // namespace omnihil
