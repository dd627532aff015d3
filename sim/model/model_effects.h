// The effects of a robot's model file and of its motor's file, as the plant takes them.
//
//   std::vector<EffectUse> uses = read_robot_effects(document, motor_document, &robot, problems);
//
// The robot's file comes first; an effect that only the motor's file names is added. Coulomb friction is left
// out: in a robot it is a number of the base model. Problems that stand at a place which is named already are
// not said again.
#pragma once
#include <vector>

#include "sim/law/effect_set.h"
#include "sim/model/model_document.h"

namespace omnihil {

// `motor` may be null; `robot` gives shapes their start values (an order from the poles) and may be null.
std::vector<EffectUse> read_robot_effects(const ModelDocument& document, const ModelDocument* motor,
                                          const RobotModel* robot, std::vector<ModelProblem>& problems);

// Whether a robot's simulation has the effect: all but those of a bench alone.
bool acts_on_robot(std::string_view effect);

}  // namespace omnihil
