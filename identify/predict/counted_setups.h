// Which effect made the measured speed of an axis, if it was counted from pulses; its signals then get that
// noise.
//
//   const EffectEntry* e = find_counted_speed(setups, drive);   // null: it was not counted
//
// Decided on the readings of all runs together: a speed that is counted in one run is so in all. Needs the
// motor's pole pairs. counted_speed.h has the law.
#pragma once
#include <vector>

#include "identify/predict/axis_setup.h"
#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"

namespace omnihil {

const EffectEntry* find_counted_speed(std::vector<AxisSetup>& setups, const DriveParams<double>& drive);

}  // namespace omnihil
