// Everything fixed about one robot: geometry, masses, wheels, tyres, motors, encoder, supply.
// Plain numbers in SI; tolerances and sources live in the model file's rows (sim/model/params.h).
// Wheel i sits at wheel_angle_rad[i] from body x (forward) towards y (left); positive drive direction is
// the body's counter-clockwise tangent. Drawn in docs/frames-and-wheels.md.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "sim/drive/motor_params.h"
#include "sim/robot/per_wheel.h"
#include "sim/robot/tyre.h"

namespace omnihil {

struct EffectUse;      // sim/law/effect_set.h
struct ElectricModel;  // sim/robot/electric_model.h
struct BallHandling;   // sim/robot/ball_handling.h

// What the robot's own firmware makes of its motors: a duty, or the legs of three phases.
enum class MotorLoop : std::uint8_t { kDuty, kFoc, kSixStep, kEmotional };

struct RobotModel {
  std::string name;
  double mass_kg = 0.0;                  // whole robot, wheels included
  double yaw_inertia_kg_m2 = 0.0;        // whole robot about the vertical through its geometric centre
  double center_of_mass_height_m = 0.0;  // above the floor
  double center_of_mass_x_m = 0.0;       // offset of the centre of mass from the geometric centre, body frame
  double center_of_mass_y_m = 0.0;
  double wheel_center_radius_m = 0.0;  // R_b: geometric centre to wheel contact
  double wheel_radius_m = 0.0;
  double wheel_mass_kg = 0.0;        // one wheel
  double wheel_inertia_kg_m2 = 0.0;  // one wheel about its axle, without the rotor
  std::size_t wheels = kWheels;  // kMinWheels to kMaxWheels; of all lists per wheel the first so many count
  PerWheel<double> wheel_angle_rad{};
  int rollers_per_wheel = 0;
  double gear_ratio = 1.0;  // rotor turns per wheel turn
  TyreCurve tyre_longitudinal;
  TyreCurve tyre_lateral;
  double slip_speed_floor_m_s = 0.0;  // below it slip is taken relative to this speed
  MotorParams motor;
  EncoderParams encoder;
  double bus_voltage_V = 0.0;
  // Three-phase drive, battery, heat; null: the DC-equivalent motor on a constant bus.
  std::shared_ptr<const ElectricModel> electric;
  // Hull, kicker, dribbler, break beam; null: the defaults.
  std::shared_ptr<const BallHandling> handling;
  MotorLoop motor_loop = MotorLoop::kDuty;
  // What firmware is told it drives, where that is another robot; null: this one.
  std::shared_ptr<const RobotModel> told;
  double control_timeout_s = 0.0;  // the team's own command timeout; 0: the firmware's default
  // On top of the base model above (Coulomb friction is part of that); null: none.
  std::shared_ptr<const std::vector<EffectUse>> effects;
};

}  // namespace omnihil
