// Relative force error of a torque-driven axis, by the recipe of the published benchmark of a linear drive.
//
//   std::optional<double> e = force_error(predictor, predictions, Split::kTraining);    // 0.0206
//
// norm(force - model) / norm(force), both decimated by ten (decimate.h). The motion from which the model's
// force follows is the predictor's (inverse method): position low-passed with a Butterworth filter of order 4
// at a fifth of the Nyquist frequency, forward and backward, differentiated by central differences, the ends
// left out (A. Janot, M. Gautier, M. Brunot, Data Set and Reference Models of EMPS, 2019).
// Over all rows, those at rest as well, where the motion does not say which force it needs: the makers' figures are.
// None where no run of that split compares a motor_torque. `predictions`: one per run of the predictor.
#pragma once
#include <optional>
#include <span>

#include "identify/predict/predictor.h"

namespace omnihil {

std::optional<double> force_error(const Predictor& predictor, std::span<const Prediction> predictions,
                                  Split split);

}  // namespace omnihil
