// Settled points (`kind = "steady"` of a run): rows that are independent of one another, each recorded when all that moves had
// settled. What they are to any rig: a row's input is held for kSettled_s until all states have settled, then a little longer, of
// which means are taken; acceleration, time and time since a step are no regimes of theirs.
//
//   std::vector<RegimeTrack> tracks = …;
//   if (run.steady) no_time(tracks);
//
// An axis is run backwards there, its speed imposed (axis_outputs.cc); what rolls is run forward from the speeds of the row
// (robot_motion.cc). Nothing goes on from one row to the next.
#pragma once
#include <algorithm>
#include <string_view>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

// A hundred electrical time constants of a small motor; of a robot of 2.5 kg that its motors drive (0.03 s) twenty. A choice.
inline constexpr double kSettled_s = 0.5;  // a choice

inline void no_time(std::vector<RegimeTrack>& tracks) {
  constexpr std::string_view kOfTime[] = {"acceleration", "time", "time_since_step"};
  std::erase_if(tracks, [&](const RegimeTrack& t) {
    return std::find(std::begin(kOfTime), std::end(kOfTime), t.name) != std::end(kOfTime);
  });
}

}  // namespace omnihil
