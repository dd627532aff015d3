// One run of an axis, ready to be predicted: what drives it, where it starts, which signals are compared and
// with what noise. Made once per run from the measurement and the nominal model.
//
//   AxisSetup s = make_axis_setup(dataset, nominal, run);
//   auto y = axis_outputs<double>(s, drive_params, effects, step_s);       // axis_outputs.h
//
// Inverse: samples are put on an even clock; the drive input and what the model needs are low-pass filtered
// alike with zero phase (Butterworth 4 at a fifth of the Nyquist frequency, at most 100 Hz), the motion by what
// stands out of its noise and by 100 Hz (axis_inverse.cc); index i of every signal refers to the interval that
// ends at sample i, in which the input of sample i - 1 was held.
#pragma once
#include <string>
#include <vector>

#include "identify/predict/channel.h"
#include "identify/record/filter.h"
#include "sim/bench/axis_sim.h"

namespace omnihil {

// Time constant of the whitening filter of differenced positions (predictor.h): slower errors weigh less. A
// choice: above the mechanical time constants of a drive, below a record's length; sensitivity not measured.
inline constexpr double kWhitening_s = 0.25;  // a choice
// The quantity of an AxisSample that a compared signal is predicted by.
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
  std::vector<std::size_t> difference_from;  // of differenced signals: index of each one's earlier sample
  double counts_per_output_rad = 0.0;        // of the encoder
  double first_temperature_degC = 0.0;
  LowPass filter;             // inverse; no sections: none
  std::vector<double> given;  // inverse: the drive input over the interval that ends at each of n samples
  // Steady points: sign of the displacement by which each was approached (the speed is input's imposed one,
  // the angle measured); -1, 0, 1.
  std::vector<double> approach;
  // For regimes: of the output, smoothed; n samples on the clock of `input`; rad/s, rad, A, degC.
  std::vector<double> velocity, position, measured_current, measured_temperature;
  std::size_t first_row = 0;  // of the run's rows
};

// Empty `input.time_s`: nothing can be predicted of this run (the reason is in compared[…].left_out where
// there is one).
AxisSetup make_axis_setup(const Dataset& dataset, const Candidate& nominal, const Run& run);

CommandKind axis_command_kind(const Dataset& dataset);
Method axis_method(const Dataset& dataset);

}  // namespace omnihil
