// Poses that repeat while the robot drives on: a sensor that went silent, whose log holds its last value.
//
//   drop_silent_frames(run, nominal, record);       // record.frames: what it repeated is not measured
//   for (const SilentStretch& s : record.silent) std::puts(s.signal.c_str());
//
// Silent is a heading (or a place, both coordinates) that is the same to its last digit for kSilent_s and kSilentRows rows,
// while the wheels' speeds, summed up, move it by more than kMoved and by more than three sigmas of that sum. Cannot:
// tell a sensor that repeats from wheels that spin in place under an exact one; see either
// without the wheels' speeds or counts.
#pragma once
#include "identify/predict/robot_record.h"

namespace omnihil {

void drop_silent_frames(const Run& run, const RollingParams<double>& nominal, RobotRecord& record);

}  // namespace omnihil
