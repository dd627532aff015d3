// A sensor with a clock of its own, such as a camera beside a robot: in each run it is off by one unknown time, of which the
// record states a sigma.
//
//   run.clock = {.sigma_s = 0.03, .follow_s = 0.5, .signals = {4, 5}};     // vision_x, vision_y
//   p.values = …;  fit_clock(run.clock, run.compared, p);
//
// Law: readings y(t + d) = y(t) + q d, to first order, and white noise s; d of N(0, sigma_s^2). In units of s the covariance is
//   C = I + sigma_s^2 q q',     C^(-1/2) = I - (1 - 1 / sqrt(1 + sigma_s^2 q'q)) q q' / q'q,
// and r' C^-1 r = min over d of |r - q d|^2 + d^2 / sigma_s^2 (Woodbury's identity; marginal and fitted shift are one). Values and
// derivatives are moved so that measurement minus value is C^(-1/2) r: noise as white as before, its sum of squares that with the
// shift fitted. q is the predicted path's rate; less that at the start, where the path begins; what a path follows is left out
// of it as of the path itself.
// Validity: shifts short beside what the motion takes to change. Cannot: a clock that drifts within a run.
#pragma once
#include <cstddef>
#include <vector>

namespace omnihil {

struct ComparedSignal;
struct Prediction;

struct OwnClock {
  double sigma_s = 0.0;   // 0: the record's own clock
  double follow_s = 0.0;  // with which the predicted path follows the sensor (follow_gain()); 0: it does not
  std::vector<std::size_t> signals;  // whose clock it is, by their place among the run's
};

// Share of the difference between a sensor and a path that follows it that is made good at a reading, `span_s` after the one
// before: a low pass of first order; at first the mean of the `count` readings so far, so that the first one's noise is
// averaged out.
double follow_gain(double span_s, double follow_s, double count);

// d/dt of n samples at k, by those beside it.
double rate_at(const std::vector<double>& time_s, const std::vector<double>& y, std::size_t k);

void fit_clock(const OwnClock& clock, const std::vector<ComparedSignal>& compared, Prediction& p);

}  // namespace omnihil
