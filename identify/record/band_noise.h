// 1-sigma of what sensors leave in the band that an imposed motion is compared in.
//
//   double torque = white_noise(samples, low, 0.2) * std::sqrt(kept_of_means(0.2));        // of a measured torque
//   double motion = needed_torque_sigma(error_spectrum, inertia_kg_m2, {}, filter, 1000.0);  // by the motion's own error
//
// Validity: white noise of the channel; the spectrum as wiener.h gives it. `band`: cutoff as a share of half the rate, 0 to 1.
#pragma once
#include <vector>

#include "identify/record/filter.h"

namespace omnihil {

// Of a channel's samples, by what stands above the cutoff, in the channel's unit; `low`: the samples through the filter. All of that
// counts as noise: an upper bound where the channel itself has something there (periodogram.h has another).
double white_noise(const std::vector<double>& samples, const std::vector<double>& low, double band);

// Share of white noise's variance that the band keeps: of samples, and of means from each to the next (interpolated by a cubic:
// the integral over the band of their gain's square, (13 cos(pi f T) - cos(3 pi f T)) / 12).
double kept_of_samples(double band);
double kept_of_means(double band);

// What the imposed motion's own error moves the torque that it needs by: sigma^2 = J^2 mean over frequency of
// S_e(f) |2 sin(pi f T) / T|^2 |M(f) F(f)|^2, the inertia times the rate of change from sample to sample. S_e: error of the
// smoothed speed (wiener.h), (rad/s)^2; M, F: low passes of the motion and of what it needs. N m for kg m2.
double needed_torque_sigma(const std::vector<double>& speed_error, double inertia_kg_m2,
                           const LowPass& motion, const LowPass& filter, double rate_Hz);

}  // namespace omnihil
