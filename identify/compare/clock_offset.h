// Does the measurement run late against the model? A constant offset between the clock of the drive input and
// that of the response, estimated and said; never applied.
//
//   std::optional<ClockOffset> o = clock_offset(predictor, predictions, "velocity");
//   o->seconds;        // 0.0031: the measured motion is 3.1 ms later than the model's
//
// The lag at which the squared error of model(t - lag) is least, in steps of the sample period, refined by a
// parabola through the three best. From eight stretches of the record, so that its spread is known.
// Cannot: separate a late clock from a delay of the drive or a missing inductance; find an offset that the
// model's error drowns.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "identify/predict/predictor.h"

namespace omnihil {

struct ClockOffset {
  double seconds = 0.0;
  double sigma_s = 0.0;
  double error_share = 0.0;  // of the error energy that it explains
  bool significant = false;  // beyond three sigmas, a tenth of a period and a twentieth of the error
};

// `predictions`: one per run of the predictor. None: fewer than two stretches compare this signal.
std::optional<ClockOffset> clock_offset(const Predictor& predictor, std::span<const Prediction> predictions,
                                        std::string_view signal);

}  // namespace omnihil
