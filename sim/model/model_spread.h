// A robot as one of many of its model: every number with a tolerance drawn about its value.
//
//   RobotModel third = spread_robot(model, 1.0, 42, 3, {});        // by the tolerances themselves, seed 42, robot 3
//
// Law: x = x_0 (1 + s tolerance g), g standard normal, held to +-3; s 0: the model itself. Each number has its own stream
// by its path, so that a model file with one more number draws the others as before. Values outside a number's bounds
// stay x_0; a robot that is none (an asymptote before its extremum, a tyre too stiff for the step) is drawn again.
// Cannot: correlations (heavier robots with more inertia), wheels that differ beyond lists of wheels in the model.
#pragma once
#include <cstdint>

#include "sim/model/model_file.h"
#include "sim/robot/plant.h"

namespace omnihil {

// `options`: of the plant that it is for. Firmware is told the model itself (RobotModel::told).
RobotModel spread_robot(const ModelFile& model, double spread, std::uint64_t seed, int robot,
                        const PlantOptions& options);

}  // namespace omnihil
