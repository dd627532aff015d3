// One picture for each system of the field that has no recording of its own to be drawn: what its law does, from a run.
//
//   for (const SeedPicture& p : seed_pictures(model)) save(p.name + ".svg", p.svg);
//
// Names: ball, contacts, kicker, chip, dribbler, break_beam, wireless, vision, mixed. Every curve is simulated here and now.
#pragma once
#include <string>
#include <vector>

#include "sim/robot/robot_model.h"

namespace omnihil {

struct SeedPicture {
  std::string name, svg;
};

std::vector<SeedPicture> seed_pictures(const RobotModel& model);

}  // namespace omnihil
