// How well a measurement repeats itself: the answers of two runs to the same input.
//
//   std::optional<double> sigma = repeat_noise(predictor, "velocity");      // none: no input was given twice
//
// Two runs repeat each other when their drive inputs and the numbers known of them are equal over the shorter
// one. sigma = rms(a - b) / sqrt(2): each answer has that error of its own. It holds what differs from run to
// run (temperature, run-in, start), which no sensor's sigma knows.
#pragma once
#include <optional>
#include <string_view>

#include "identify/predict/predictor.h"

namespace omnihil {

std::optional<double> repeat_noise(const Predictor& predictor, std::string_view signal);

}  // namespace omnihil
