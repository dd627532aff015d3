// Inverse method: the measured motion is imposed, and the model predicts the drive input (or the bench's
// torque) that it requires; as axis_setup.h describes it. And steady points.
//
// Steady points: each row alone, the speed constant (zero where it was not measured). At rest friction's sign
// is the direction in which the point was approached: that of the last displacement larger than noise
// (hysteresis of a thousandth of the record's range, at least three quanta).
#pragma once
#include "identify/predict/axis_record.h"
#include "identify/predict/axis_setup.h"

namespace omnihil {

// `drive`: nominal, by whose inertia the imposed speed's error is noise of the torque.
void make_inverse_setup(const Dataset& dataset, const DriveParams<double>& drive, const AxisRecord& record,
                        AxisSetup& setup);
void make_steady_setup(const Dataset& dataset, const AxisRecord& record, AxisSetup& setup);

// Speed of the output in rad/s (m/s), one per sample of the record: from its sensor, else position or counts;
// low-passed without delay where the clock is even.
std::vector<double> smoothed_velocity(const AxisRecord& record);

}  // namespace omnihil
