// Finds whether the measured speed of an axis was counted from pulses, and by which effect; its signals then
// get the noise of a count (DECISIONS 54).
//
//   const EffectEntry* e = find_counted_speed(setups, drive);   // null: it was not counted
//
// Decided on the readings of all runs together: a speed that is counted in one run is counted in all. Needs
// the motor's pole pairs. Law: counted_speed.h.
#pragma once
#include <vector>

#include "identify/predict/axis_setup.h"
#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"

namespace omnihil {

const EffectEntry* find_counted_speed(std::vector<AxisSetup>& setups, const DriveParams<double>& drive);

}  // namespace omnihil
