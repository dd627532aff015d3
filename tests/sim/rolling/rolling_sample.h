// A plant's robot as the rolling model has it.
//
//   RollingRobot<double> robot(rolling(sample_robot(), false), uses, values);      // without its tyre it rolls
#pragma once
#include "sim/rolling/rolling_robot.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {

// The numbers of a plant's robot; without its tyre it rolls.
inline RollingParams<double> rolling(const RobotModel& m, bool tyre) {
  RollingParams<double> p;
  p.drive.resistance_ohm = m.motor.resistance_ohm;
  p.drive.inductance_H = m.motor.inductance_H;
  p.drive.torque_constant_Nm_per_A = m.motor.torque_constant_Nm_per_A;
  p.drive.rotor_inertia_kg_m2 = m.motor.rotor_inertia_kg_m2;
  p.drive.viscous_friction_Nm_s_per_rad = m.motor.viscous_friction_Nm_s_per_rad;
  p.drive.current_limit_A = m.motor.current_limit_A;
  p.drive.gear_ratio = m.gear_ratio;
  p.drive.load_inertia_kg_m2 = m.wheel_inertia_kg_m2;
  p.drive.supply_voltage_V = m.bus_voltage_V;
  p.mass_kg = m.mass_kg;
  p.yaw_inertia_kg_m2 = m.yaw_inertia_kg_m2;
  p.center_of_mass_x_m = m.center_of_mass_x_m;
  p.center_of_mass_y_m = m.center_of_mass_y_m;
  p.center_of_mass_height_m = m.center_of_mass_height_m;
  p.wheel_center_radius_m = m.wheel_center_radius_m;
  p.wheel_radius_m = m.wheel_radius_m;
  p.wheels = m.wheels;
  p.wheel_angle_rad = m.wheel_angle_rad;
  p.has_tyre = p.has_lateral_tyre = tyre;
  const auto curve = [](const TyreCurve& c) {
    return RollingTyre<double>{c.extremum_slip, c.extremum_value, c.asymptote_slip, c.asymptote_value};
  };
  p.longitudinal = curve(m.tyre_longitudinal);
  p.lateral = curve(m.tyre_lateral);
  p.slip_speed_floor_m_s = m.slip_speed_floor_m_s;
  return p;
}

}  // namespace omnihil
