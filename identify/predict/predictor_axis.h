// Rig "axis": what one drive on a bench would have shown its sensors (predictor.h). Made by make_predictor.
//
// Derivatives are exact: the drive is run on dual numbers, eight unknowns at a time. One exception: a delay
// in front of a limit of the target's speed moves the instant at which the limit starts to act, which no
// derivative within a sub-step sees; it gets the difference of two runs. The sub-step is the longest (half,
// quarter … of the sampling period, never longer than 1 ms) at which the nominal model's predictions agree
// with those of a quarter of it within a tenth of the noise; models with an effect on the shaft, or with
// presliding friction, take PredictOptions::step_s if that is shorter.
#pragma once
#include <memory>

#include "identify/predict/axis_setup.h"
#include "identify/predict/predictor.h"

namespace omnihil {

std::unique_ptr<Predictor> make_axis_predictor(const Dataset& dataset, const Candidate& nominal,
                                               const PredictOptions& options);

// By what drives it and what is measured.
Capabilities axis_capabilities(const Dataset& dataset, const Candidate& nominal);
// Settled points of a drive by duty or voltage: what is lost before the winding is not searched, any of it would explain each speed.
bool hides_losses_before_winding(const Dataset& dataset);
// A drive by torque whose motion is told by a reported speed alone: that is the model's input, with what its electronics do to it.
bool takes_speed_as_reported(const Dataset& dataset);

// Tracks of a run for sorting errors; `model`: the run as the model has it, for what was not measured.
std::vector<RegimeTrack> axis_regimes(const AxisSetup& setup, const Candidate& model, double step_s);

}  // namespace omnihil
