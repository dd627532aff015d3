// Force over slip of each wheel of a robot that was recorded: the paper's way, from encoders, body speed and motor torque.
//
//   TyrePoints points = tyre_points(dataset, nominal, faults);        // nothing in `faults`: it could be told
//   points.all[0].slip, points.all[0].ratio;                          // force over wheel load
//
// Law: slip  s = (R w - v) / max(|v|, |R w|, floor)                 eq. (6), positive where the wheel drives
//      force F = (g (k i - b g w - c sign(w)) - J dw/dt) / R         at the rim; J = J_wheel + g^2 J_rotor
//      i measured (mean over the sample), or eq. (7): i = (u - k g w) / R_winding
//      load  N of wheel_load.h for the sum of the four forces
// v of the wheel's middle along its drive direction (eq. 5) from the camera's places, the accelerometers and the gyro;
// R w from the encoder; both by motion_smoother.h, whose errors give the slip's. R is the intercept of
// v / w over the force where wheels carry less than a quarter of the largest, since 1 % of R would be 0.01 of slip.
// Source: Bakhshandeh Babarsad and Sharbafi 2012, section III.B, eqs. (5) to (7), the method of their Fig. 8.
// Cannot: slip that is gone sooner than about 20 ms; lateral force.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "identify/predict/candidate.h"
#include "identify/record/dataset.h"

namespace omnihil {

struct TyrePoint {
  int wheel = 0;
  double time_s = 0.0;
  double slip = 0.0, slip_sigma = 0.0;
  double ratio = 0.0, ratio_sigma = 0.0;  // force over load
  double speed_m_s = 0.0;                 // the larger of hub's and rim's
};

struct TyrePoints {
  std::vector<TyrePoint> all;
  double radius_m = 0.0;  // at which unloaded wheels roll
  double radius_sigma_m = 0.0;
  bool measured_current = false;  // else by eq. (7)
};

// What is missing goes to `faults`, each with what would give it; the points are then empty.
TyrePoints tyre_points(const Dataset& dataset, const Candidate& nominal, std::vector<std::string>& faults);

}  // namespace omnihil
