// Repeatability of a measurement: the difference of two runs' responses to the same input.
//
//   std::optional<double> sigma = repeat_noise(predictor, "velocity");      // none: no input was given twice
//
// Two runs repeat each other when their drive inputs and the parameters known of them are equal over the
// shorter one. sigma = rms(a - b) / sqrt(2), in the signal's unit: the error of one response, if both have
// the same. It includes what differs from run to run (temperature, run-in, start), which no sensor's sigma
// does.
#pragma once
#include <optional>
#include <string_view>

#include "identify/predict/predictor.h"

namespace omnihil {

std::optional<double> repeat_noise(const Predictor& predictor, std::string_view signal);

}  // namespace omnihil
