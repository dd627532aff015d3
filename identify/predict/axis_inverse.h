// Runs whose motion is taken as measured: the model says which drive input (or which torque of the bench)
// that motion takes. What axis_setup.h says of the inverse method; and steady points.
//
// Steady points: each row alone, the speed constant (zero where it was not measured). At rest friction's sign
// is the direction in which the point was approached: that of the last move that was larger than noise
// (hysteresis of a thousandth of the record's range, at least three quanta).
#pragma once
#include "identify/predict/axis_record.h"
#include "identify/predict/axis_setup.h"

namespace omnihil {

void make_inverse_setup(const Dataset& dataset, const AxisRecord& record, AxisSetup& setup);
void make_steady_setup(const Dataset& dataset, const AxisRecord& record, AxisSetup& setup);

// Speed of the output from whatever was measured, low-passed without delay where the clock is even.
std::vector<double> smoothed_velocity(const AxisRecord& record);

}  // namespace omnihil
