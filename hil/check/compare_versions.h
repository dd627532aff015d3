// Two builds or two models against one recording and against each other: which is closer to what was recorded.
//
//   VersionsComparison both = compare_versions(recording, format, a, b, tolerances);
//   both.rows[0].b_rms;                            // RMS of recorded minus B, in the signal's unit
//   versions_table(both);                          // one row per signal
#pragma once
#include <string>
#include <vector>

#include "hil/recording/compare_recordings.h"
#include "hil/recording/replay_run.h"

namespace omnihil {

struct VersionRow {
  std::string signal;
  std::string unit;
  double a_rms = 0.0, b_rms = 0.0;  // of the difference to the recording
  double between_rms = 0.0;         // of B to A
  double between_largest = 0.0;
  double tolerance = 0.0;
};

struct VersionsComparison {
  ReplayRun a, b;
  std::vector<VersionRow> rows;     // signals in which all three could be compared
  std::optional<Difference> first;  // where B first leaves A by more than a tolerance
};

VersionsComparison compare_versions(const Recording& recording, const RadioFormat& format,
                                    const ReplayOptions& a, const ReplayOptions& b,
                                    const Tolerances& tolerances);

std::string versions_table(const VersionsComparison& both);

}  // namespace omnihil
