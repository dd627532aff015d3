// A robot on four omni wheels whose rollers are there: each a free body of its own in Simbody, one per wheel on the floor.
//
//   FullWheelRobot robot(model, {});                      // 4 wheels, 18 rollers each
//   robot.set_volts({4, -4, -4, 4});
//   robot.advance(1e-4);                                  // one step
//   robot.state().v_x_m_s;
//
// Rollers sit on a circle of radius a = R - r about the axle, their axes tangential, barrels whose envelope is the wheel's
// circle: r(delta) = R cos(delta) - a at the angle delta from the roller's middle. The lowest one carries the wheel's load
// N (wheel_load.h, transfer by the forces of the step before); at the hand-over, delta = +-10 degrees, the next one takes
// over as it turns. Contact, one material in both directions:
//   s = |u| / max(|v|, |R omega|, floor),   F = -grip(s) N u / |u|,   u: velocity of the roller's lowest point (tyre.h, slip.h)
//   I dw/dt = r F_across - c N r tanh(w / w_s)             bearing friction of the loaded roller, c of the lateral curve
// so that a wheel pushed sideways with rolling rollers feels c N, as the simplified wheel's lateral curve says: its
// parameters are the rollers', not fitted. A roller is so light that its spin is solved implicitly within the step
// (bisection of a monotone balance); all else is semi-implicit Euler.
// Source: Bakhshandeh Babarsad and Sharbafi 2012, Fig. 2 (18 side wheels); geometry: our derivation.
// Cannot: gaps between rollers (bumps), bending, contact off the vertical plane through the axle, tipping.
#pragma once
#include <array>
#include <memory>

#include "sim/robot/planar_state.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

struct RollerParams {
  int count = 18;              // of each wheel: the paper's
  double radius_m = 0.006;     // in the middle: guess, usual for 54 mm wheels
  double mass_kg = 0.002;      // each: guess, steel pin and rubber
  double bearing_rad_s = 5.0;  // w_s: speed of full bearing friction
};

class FullWheelRobot {
 public:
  FullWheelRobot(const RobotModel& model, const RollerParams& rollers);
  ~FullWheelRobot();
  FullWheelRobot(FullWheelRobot&&) noexcept;
  FullWheelRobot& operator=(FullWheelRobot&&) noexcept;

  // At the windings; motor torque k (u - k w) / R, eq. (7), less viscous friction.
  void set_volts(const std::array<double, kWheels>& volt);
  // Instead of motors: torques at the wheels.
  void set_torques(const std::array<double, kWheels>& torque_Nm);
  // A force on the geometric centre, field frame: for tests.
  void push(double x_N, double y_N);
  void advance(double step_s);

  PlanarState state() const;  // of the geometric centre
  void set_velocity(double v_x_m_s, double v_y_m_s, double omega_rad_s);
  std::array<double, kWheels> wheel_rad_s() const;
  double roller_rad_s(std::size_t wheel) const;  // of the one on the floor
  std::array<double, kWheels> force_along_N() const;
  std::array<double, kWheels> force_across_N() const;
  // Sums since the start: energy of all bodies = work put in - work lost, but for the integrator.
  double kinetic_J() const;
  double work_in_J() const;    // motors and push
  double work_lost_J() const;  // slip and bearings

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil
