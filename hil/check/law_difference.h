// In what the duties of two firmwares with the same inputs differ: the term of a speed loop that the difference grows
// with, and by how much.
//
//   const auto law = law_difference(recorded, alone.answer, 0, 2);       // see firmware_alone.h
//   law->text();       // "grows with the speed error, -0.0164 V s/rad (R^2 0.97): a P gain"
//
// Simple regression of the voltage difference on one term at a time, u = duty * supply:
//   u itself, the speed error e, its integral, the target, the speed's slope
// (the terms of a PI-D loop with feedforward; Åström and Hägglund, Advanced PID Control, 2006, chapter 3).
// Targets are those that the firmware feeds back, speeds are counted from the encoder behind the low pass, of several,
// with which a term explains most. Cannot: name two changes at once, or a law of another
// form: then no term explains enough and nothing is named.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/recording/recording.h"

namespace omnihil {

struct LawDifference {
  std::string term;  // "the speed error"
  std::string what;  // "a P gain"
  std::string unit;
  double slope = 0.0;
  double r_squared = 0.0;

  std::string text() const;
};

// `wheel` from 0. Both with the same inputs. Nothing where the duties are alike, columns are missing, or no term
// explains the difference.
std::optional<LawDifference> law_difference(const Recording& recorded, const Recording& alone, int robot_id,
                                            int wheel);

// Of all robots and wheels, a line each.
std::vector<std::string> law_differences(const Recording& recorded, const Recording& alone);

}  // namespace omnihil
