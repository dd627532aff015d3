// One run of an axis, ready to be predicted: what drives it, where it starts, which signals are compared and
// with what noise. Made once per run from the measurement and the nominal model.
//
//   AxisSetup s = make_axis_setup(dataset, nominal, run, Method::kForward);
//   auto y = axis_outputs<double>(s, drive_params, effects, step_s);       // axis_outputs.h
//
// Inverse: samples are put on an even clock, motion and drive input are low-pass filtered alike with zero
// phase (Butterworth 4 at a fifth of the Nyquist frequency, at most 100 Hz), and index i of every signal
// stands for the interval that ends at sample i, in which the input of sample i - 1 was held.
#pragma once
#include <string>
#include <vector>

#include "identify/predict/predictor.h"
#include "identify/record/filter.h"
#include "sim/bench/axis_sim.h"

namespace omnihil {

inline constexpr double kWhitening_s = 0.25;  // slower errors of a differenced position weigh less: a choice

// What of an AxisSample a compared signal is.
enum class AxisOutput : std::uint8_t {
  kVelocity,
  kCountsDifferenced,
  kPositionDifferenced,
  kPosition,
  kCurrent,
  kWindingTemperature,
  kBusVoltage,
  kLoadTorque,
  kNeededInput,
};

struct AxisSetup {
  Method method = Method::kForward;
  bool steady = false;
  bool speed_imposed = false;  // the speed is imposed by the bench, not by the filter's motion
  AxisInput input;
  std::vector<ComparedSignal> compared;
  std::vector<AxisOutput> outputs;           // one per compared signal
  std::vector<std::size_t> difference_from;  // of differenced signals: the sample that each is held against
  double counts_per_output_rad = 0.0;        // of the encoder
  double first_temperature_degC = 0.0;
  LowPass filter;             // inverse; no sections: none
  std::vector<double> given;  // inverse: the drive input over the interval that ends at each sample
  // Steady points: the speed is imposed.input, the angle measured; from where the point was approached.
  std::vector<double> approach;
  // For regimes: of the output, smoothed; on the clock of `input`.
  std::vector<double> velocity, position, measured_current, measured_temperature;
  std::size_t first_row = 0;  // of the run's rows
};

// Empty `input.time_s`: nothing can be predicted of this run (said in compared[…].left_out where there is
// one).
AxisSetup make_axis_setup(const Dataset& dataset, const Candidate& nominal, const Run& run);

CommandKind axis_command_kind(const Dataset& dataset);
Method axis_method(const Dataset& dataset);

// Typical sensor noise of a record that nobody stated: robust size of its second differences, at least its
// quantum / sqrt(12).
struct NoiseEstimate {
  double sigma = 0.0;
  double quantum = 0.0;
};
NoiseEstimate estimate_noise(const std::vector<double>& values);

}  // namespace omnihil
