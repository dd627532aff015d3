// Speed and acceleration of something whose place and acceleration were measured with noise, as they most likely were.
//
//   std::vector<MotionSample> in(n);                       // time, place, its sigma; empty: not measured then
//   SmoothedMotion out = smooth_motion(in);
//   out.at[k].speed; out.at[k].speed_sigma;
//
// Model: jerk is white noise of spectral density q; state (place, speed, acceleration, bias of the acceleration's
// sensor). Kalman filter forward, Rauch-Tung-Striebel smoother back (Rauch, Tung and Striebel 1965, AIAA J. 3(8); process
// noise of the white-jerk model: Bar-Shalom, Li and Kirubarajan 2001, "Estimation with Applications to Tracking and
// Navigation", 6.2.3). q is the one of greatest likelihood among powers of ten. Units follow those of `place`.
// Cannot: outliers; a sensor's noise that is not white.
#pragma once
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace omnihil {

struct MotionSample {
  double time_s = 0.0;
  double place = std::numeric_limits<double>::quiet_NaN();  // NaN: not measured
  double place_sigma = 1.0;
  double acceleration = std::numeric_limits<double>::quiet_NaN();
  double acceleration_sigma = 1.0;
};

struct MotionState {
  double place = 0.0, speed = 0.0, acceleration = 0.0;
  double speed_sigma = 0.0, acceleration_sigma = 0.0;
};

struct SmoothedMotion {
  std::vector<MotionState> at;  // one per sample
  double jerk_density = 0.0;    // q: place^2 / s^5
  double log_likelihood = 0.0;
};

SmoothedMotion smooth_motion(std::span<const MotionSample> samples);

}  // namespace omnihil
