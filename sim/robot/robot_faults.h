// What goes wrong with one robot while it drives: put in force at an instant, in force until changed.
//
//   RobotFaults faults;                       // neutral: a healthy robot, left alone
//   faults.encoder_stuck[2] = true;
//   faults.force_forward_N = 5.0;
//   plant.set_faults(robot, faults);          // …
//   plant.set_faults(robot, {});              // healthy again
//
// Laws:
//   force, moment     act at the geometric centre, body frame, as an impulse per mechanical step h:
//                     v += a h with a of planar_law.h for the added force alone; first order in h
//   supply_ratio      every bridge sees supply_ratio times the bus, and so does the voltage sensor; it
//                     takes the place of a sag that effects describe
//   winding_rise_K    R = R_25 (1 + alpha dT), alpha = kCopperPerK (thermal.h); with a heat model of its own
//                     the winding is put at that temperature and cools from there
//   lifted            no horizontal force between floor and wheel, load 0; the free body keeps its vertical
//                     one (a jack carries it). The load of the other wheels is as before
//   blocked           the wheel stands, whatever turns it (dry friction of kBlocked_Nm); its momentum is lost
//   encoder_stuck     counts (and the angle sensor of a three-phase drive) stay as they were read last;
//                     Hall sensors live on
//   phase_lost        DC-equivalent motor: winding open, no torque. Three phases: leg a of the bridge dead,
//                     its diodes conduct
// Cannot represent: a load that moves to the other wheels when one is lifted, tipping by a force, a phase cut
// at the motor (its diodes would not conduct), the robot on its stand swinging.
#pragma once
#include <array>

#include "firmware_iface/robot_io.h"
#include "sim/robot/per_wheel.h"

namespace omnihil {

struct RobotFaults {
  double force_forward_N = 0.0, force_left_N = 0.0, moment_Nm = 0.0;
  double supply_ratio = 1.0;
  PerWheel<double> winding_rise_K{};
  PerWheel<bool> lifted{}, blocked{}, encoder_stuck{}, phase_lost{};

  bool operator==(const RobotFaults&) const = default;
};

// Far beyond any motor's torque, far below where numbers lose their place.
inline constexpr double kBlocked_Nm = 1e6;

}  // namespace omnihil
