// What `replay` and `check` say to people about a recording and about a comparison: pure text.
#pragma once
#include <string>

#include "hil/recording/compare_recordings.h"
#include "hil/recording/replay_run.h"

namespace omnihil {

// "6 robots ulaval_delta, ulaval-hermes, simbody, 8.000 s, recorded by commit 1a2b3c4; cut off …"
std::string recording_line(const Recording& recording);
// Firmware, wall time, packets of the host.
std::string replay_line(const Recording& recording, const ReplayRun& run);
// One row per signal: values compared, largest difference and where, tolerance.
std::string comparison_table(const RecordingComparison& comparison);

}  // namespace omnihil
