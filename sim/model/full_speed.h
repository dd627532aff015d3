// How fast a robot's rims run at full duty, without load.
//
//   double most_m_s = full_speed_m_s(robot);
#pragma once
#include "sim/robot/robot_model.h"

namespace omnihil {

inline double full_speed_m_s(const RobotModel& m) {
  return m.bus_voltage_V / (m.motor.torque_constant_Nm_per_A * m.gear_ratio) * m.wheel_radius_m;
}

}  // namespace omnihil
