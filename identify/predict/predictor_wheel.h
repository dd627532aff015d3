// Rig "wheel": one omni wheel of a robot on a floor, its body moved by the bench: a belt, a drum, a carriage on rails.
//
//   std::unique_ptr<Predictor> p = make_wheel_predictor(dataset, robot, options);
//
// The model is the robot's own file. Its wheel stands on the floor with its share of the robot's weight,
//     N = m g / n,
// drives along x (forward) and lets its rollers turn along y (left). Given: duty (or enable), the body's velocity body_vx,
// body_vy in m/s over the floor, bus voltage. Compared: encoder, current, bus, and what a load cell sees of the floor's
// force on the wheel: force_x, force_y in N. What it finds of motor and tyre stands in the robot's file, where the
// robot's own runs are compared with it.
// Cannot: a body that turns, a load that changes, a force measured through a mount that swings.
#pragma once
#include <memory>

#include "identify/predict/predictor.h"

namespace omnihil {

std::unique_ptr<Predictor> make_wheel_predictor(const Dataset& dataset, const Candidate& robot,
                                                const PredictOptions& options);

}  // namespace omnihil
