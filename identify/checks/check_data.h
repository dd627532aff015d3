// Faults of the data, or of how they were taken; said before any physics.
//
//   for (const DataFinding& f : check_data(dataset, nominal)) std::puts(f.sentence.c_str());
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "identify/predict/candidate.h"
#include "identify/record/dataset.h"

namespace omnihil {

struct DataFinding {
  enum class Grade : std::uint8_t { kNote, kDoubt, kFault };  // kFault: results would mislead
  Grade grade = Grade::kNote;
  std::string kind;    // "clock_jitter", "glitch", "swapped_sign", "wrong_scale", "dropped_counts",
                       // "late_timestamps", "saturated_command", "position_against_speed", "closed_loop", …
  std::string run;     // file; empty: all
  std::string signal;  // empty: none in particular
  double size = 0.0;   // in the signal's unit, or the sentence's
  std::string sentence;
};

// Data quality alone: clock, glitches, signs, scales, saturation, position against the integral of speed.
std::vector<DataFinding> check_data(const Dataset& dataset, const Candidate& nominal);

// Of the grade kFault; null: none.
const DataFinding* first_fault(const std::vector<DataFinding>& findings);

}  // namespace omnihil
