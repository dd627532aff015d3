// Tolerance tubes: how far a measurement may be from the model and still agree.
//
//   std::string fault;
//   std::optional<Tube> tube = parse_tube("velocity=5%/0.01", fault);   // 5 % of its range, 10 ms in time
//   TubeResult r = hold_in_tube(predictor, predictions, *tube);         // r.outside, the first and the worst
//
// SIGNAL=TOLERANCE, in the signal's unit or, with %, of the range of what was measured. /TIME widens the tube
// in time: a sample agrees when it lies between the least and the largest value of the model within that many
// seconds, the tolerance added. Samples that were not measured are not judged; a model that diverged is
// outside.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "identify/predict/predictor.h"

namespace omnihil {

struct Tube {
  std::string signal;
  double tolerance = 0.0;
  bool relative = false;  // of the measured range
  double time_s = 0.0;
};

std::optional<Tube> parse_tube(std::string_view text, std::string& fault);

struct TubeResult {
  std::size_t samples = 0;  // 0: no run compares this signal
  std::size_t outside = 0;
  double worst = 0.0;  // farthest outside, in the signal's unit
  std::string worst_run, first_run;
  double worst_s = 0.0, first_s = 0.0;
};

// `predictions`: one per run of the predictor.
TubeResult hold_in_tube(const Predictor& predictor, std::span<const Prediction> predictions,
                        const Tube& tube);

}  // namespace omnihil
