// How a channel is read, whatever the rig: its noise estimated, taken out of an input, drawn; gaps of an input held; the
// speed that positions begin with; the time since an input last made a step.
//
//   NoiseEstimate e = estimate_noise(current_A);   // e.sigma, e.quantum
//   std::vector<double> bus = without_noise(held(run.signal("bus_voltage")), e.sigma, windows);
//   double seen = reading(value, e.sigma, e.quantum, normal);
//
// What of a motion it sees: observation.h.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

// No sensor's noise is below this share of its signal's rms about the mean: 80 dB. A guess.
inline constexpr double kLeastNoiseShare = 1e-4;  // a guess

// Sensor noise of a record whose channel states none: robust sigma of its second differences; where the signal itself bends
// from row to row (a camera's, telemetry's: tens of rows a second) those of its third, which then are smaller by more than
// chance. Where most of the differences are exactly zero, those of the rows that do not stand still. At least its quantum /
// sqrt(12) and kLeastNoiseShare. In the signal's unit.
struct NoiseEstimate {
  double sigma = 0.0;
  double quantum = 0.0;
};
NoiseEstimate estimate_noise(const std::vector<double>& values);

// Puts a channel's noise into its signal: what is stated is the sensor's own, and its reading is rounded on top, q^2 / 12
// (Widrow 1956); 0: not stated, estimated.
void set_noise(double stated_sigma, const NoiseEstimate& estimate, ComparedSignal& signal);

// 1-sigma of a channel's noise: stated, else estimated from these values of it.
double noise_sigma_of(const Dataset& dataset, std::string_view channel, const std::vector<double>& values);

// Reading of a quantised sensor: noise is added before rounding; sigma^2 includes the rounding's q^2 / 12.
double reading(double value, double sigma, double quantum, double normal);

// Rows from `first` on, missing ones held at the last value; before the first value, at that one. Empty: nothing is known.
std::vector<double> held(const std::vector<double>* column, std::size_t first = 0);

// The same with its missing values; empty: nothing of it is known.
std::vector<double> from_row(const std::vector<double>* column, std::size_t first);

double first_known(const std::vector<double>& values, double otherwise);

// A window's mean of a measured input, in samples to either side. Longer ones first: the longest whose variance is no
// more than `tolerated` times the noise's is taken.
struct NoiseWindows {
  std::span<const std::size_t> half;
  double tolerated = 1.0;
};
// A measured bus voltage is an input of the model: its sensor's noise would appear as current and, integrated, as speed
// (white noise of 20 mV moves a rotor's angle ten times as much as an encoder's rounding). Each sample is the mean of
// its window; where even the shortest shows more than noise, the deviation is kept by its share of variance beyond the
// noise: local linear minimum mean square error filter (J.-S. Lee, IEEE PAMI 2(2), 1980). Records shorter than the shortest
// window, and those without noise, stay as they are.
std::vector<double> without_noise(const std::vector<double>& x, double sigma, const NoiseWindows& windows);

// A run's bus voltage from row `first` on, as what feeds the bridges and as what is compared. Empty: not measured.
struct BusReading {
  std::vector<double> input_V;     // held over what is missing, less the sensor's noise
  std::vector<double> measured_V;  // NaN where missing, or what no supply gives (bus_voltage.h)
  double sigma_V = 0.0;            // of the sensor: stated, or estimated
  std::size_t left_out = 0;        // readings that no supply gives
};
BusReading read_bus(const Dataset& dataset, const Run& run, std::size_t first, const NoiseWindows& windows);
void say_left_out(const BusReading& bus, ComparedSignal& signal);

// Speed at the first of the positions x(t), t and x from `from` to before `to`, by a least-squares parabola. Zero where it
// is within three of its standard errors (p = 0.3 %) plus a tenth of the speed gained over the span (error of the parabola
// itself; a choice): most records start at rest. NaN: fewer than four are known, or the first is not.
double first_slope(const std::vector<double>& t, const std::vector<double>& x, std::size_t from,
                   std::size_t to);

// Time since one of the inputs was last moved by more than a twentieth of its range (a choice) away from where it was
// then; s, n samples. Missing values hold.
std::vector<double> since_step(const std::vector<double>& time_s,
                               const std::vector<std::vector<double>>& inputs);

}  // namespace omnihil
