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
#include "identify/predict/axis_record.h"
#include "identify/predict/observation.h"
#include "sim/bench/axis_sim.h"

namespace omnihil {

// Longest time constant of the whitening filter of differenced positions (predictor.h): slower errors weigh less. A
// choice: above the mechanical time constants of a drive, below a record's length; sensitivity not measured. Where the
// bus is a measured input its noise makes it shorter (input_wander.h).
inline constexpr double kWhitening_s = 0.25;  // a choice
// Tuned on ten open cases of the hidden-effect test and our own: of ten, 0.125, 0.0625 and 0.004 s left 3, 2 and 3 unanswered,
// but below 0.125 a play is no longer told from a compliance (SlowDiagnoseTest.NamesPlay).
inline constexpr double kShortestWhitening_s = 0.125;  // tuned

struct AxisSetup : RigRun {
  Method method = Method::kForward;
  bool steady = false;
  AxisInput input;
  double first_temperature_degC = 0.0;
  // Steady points: sign of the displacement by which each was approached (the speed is input's imposed one,
  // the angle measured); -1, 0, 1.
  std::vector<double> approach;
  // For regimes: of the output, smoothed; n samples on the clock of `input`; rad/s, rad, A, degC.
  std::vector<double> velocity, position, measured_current, measured_temperature;
};

// Empty `input.time_s`: nothing can be predicted of this run (the reason is in compared[…].left_out where
// there is one).
AxisSetup make_axis_setup(const Dataset& dataset, const Candidate& nominal, const Run& run);

// Of make_axis_setup. Inverse: the measured motion is imposed, and the model predicts the drive input (or the bench's torque)
// that it requires; `drive`: nominal, by whose inertia the imposed speed's error is noise of the torque. Steady points: each
// row alone, the speed constant (zero where it was not measured). At rest friction's sign is the direction in which the
// point was approached: that of the last displacement larger than noise (hysteresis of a thousandth of the record's range,
// at least three quanta).
void make_inverse_setup(const Dataset& dataset, const DriveParams<double>& drive, const AxisRecord& record,
                        AxisSetup& setup);
void make_steady_setup(const Dataset& dataset, const AxisRecord& record, AxisSetup& setup);
// Speed of the output in rad/s (m/s), one per sample of the record: from its sensor, else position or counts;
// low-passed without delay where the clock is even.
std::vector<double> smoothed_velocity(const AxisRecord& record);

CommandKind axis_command_kind(const Dataset& dataset);
bool speed_is_imposed(const Dataset& dataset);
inline bool is_torque(CommandKind kind) {
  return kind == CommandKind::kMotorTorque || kind == CommandKind::kMotorCurrent;
}
Method axis_method(const Dataset& dataset);

}  // namespace omnihil
