// Robots built in code for the physics tests, and how the tests drive them.
#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/robot/plant.h"

namespace omnihil {

constexpr double kDegree = std::numbers::pi / 180.0;

// About a league robot: 2.4 kg, geared drives, centre of mass off the middle (guesses; tests need no more).
inline RobotModel sample_robot() {
  RobotModel m;
  m.name = "sample";
  m.mass_kg = 2.4;
  m.yaw_inertia_kg_m2 = 0.012;
  m.center_of_mass_height_m = 0.045;
  m.center_of_mass_x_m = 0.004;
  m.center_of_mass_y_m = -0.003;
  m.wheel_center_radius_m = 0.0805;
  m.wheel_radius_m = 0.027;
  m.wheel_mass_kg = 0.04;
  m.wheel_inertia_kg_m2 = 2.2e-5;
  m.wheel_angle_rad = {55 * kDegree, 135 * kDegree, 225 * kDegree, 305 * kDegree};
  m.rollers_per_wheel = 15;
  m.gear_ratio = 3.0;
  m.tyre_longitudinal = kDefaultTyreLongitudinal;
  m.tyre_lateral = kDefaultTyreLateral;
  m.slip_speed_floor_m_s = kDefaultSlipSpeedFloor_m_s;
  m.motor.name = "sample";
  m.motor.resistance_ohm = 0.464;
  m.motor.inductance_H = 0.000322;
  m.motor.torque_constant_Nm_per_A = 0.0255;
  m.motor.rotor_inertia_kg_m2 = 9.25e-6;
  m.motor.viscous_friction_Nm_s_per_rad = 2e-6;
  m.motor.coulomb_friction_Nm = 2.5e-3;
  m.motor.current_limit_A = 10.0;
  m.motor.duty_limit_ratio = 1.0;
  m.encoder.counts_per_turn = 4096;
  m.bus_voltage_V = 24.0;
  return m;
}

// Mirror image of itself about the x axis, centre of mass in the middle: what goes straight stays straight.
inline RobotModel symmetric_robot() {
  RobotModel m = sample_robot();
  m.name = "symmetric";
  m.center_of_mass_x_m = m.center_of_mass_y_m = 0.0;
  m.wheel_angle_rad = {60 * kDegree, 135 * kDegree, -135 * kDegree, -60 * kDegree};
  return m;
}

inline RobotModel frictionless_motor(RobotModel m) {
  m.motor.viscous_friction_Nm_s_per_rad = 0.0;
  m.motor.coulomb_friction_Nm = 0.0;
  return m;
}

inline RobotDrive duty_drive(const PerWheel<double>& duty_ratio) {
  RobotDrive d{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    d.mode[i] = OMNIHIL_DRIVE_DUTY;
    d.duty_ratio[i] = duty_ratio[i];
  }
  return d;
}

// Hard driving: every wheel goes through both directions, through zero and into slip.
inline RobotDrive excitation_drive(int robot, double t_s) {
  PerWheel<double> duty{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    const auto wheel = static_cast<double>(i);
    duty[i] =
        0.45 * std::sin(2.1 * t_s + 1.3 * wheel + 0.37 * robot) + 0.15 * std::sin(11.0 * t_s + 0.7 * wheel);
  }
  return duty_drive(duty);
}

// Drives all robots by excitation_drive() for a time, with a new duty each millisecond.
inline void excite(Plant& plant, double duration_s) {
  const auto end_ns = plant.now_ns() + std::llround(duration_s * 1e9);
  while (plant.now_ns() < end_ns) {
    for (int n = 0; n < plant.robot_count(); ++n) {
      plant.write(n, excitation_drive(n, static_cast<double>(plant.now_ns()) * 1e-9));
    }
    plant.advance(1'000'000);
  }
}

inline Plant one_robot(const RobotModel& model, const PlantOptions& options) {
  const std::vector<RobotModel> robots{model};
  return Plant(robots, options);
}

inline PlantOptions planar_options(std::int64_t step_ns = 1'000'000,
                                   Integrator integrator = Integrator::kRungeKutta4) {
  PlantOptions o;
  o.physics = Physics::kPlanar;
  o.integrator = integrator;
  o.mechanical_step_ns = step_ns;
  return o;
}

}  // namespace omnihil
