// `--with ID.parameter=value` for robots: effects added to, or changed in, a robot's model text, so that a
// recording that keeps the text keeps them too and replays the same.
//
//   std::vector<std::string> faults;
//   add_effects(bundle, {"battery_sag.resistance_ohm=0.05", "floor_tilt"}, faults);   // bundle.robot_text
//
// An effect's section of the text is replaced whole, with its other numbers kept (comments within it are
// not).
#pragma once
#include <string>
#include <vector>

#include "hil/loop/model_store.h"

namespace omnihil {

// `with`: "ID.parameter=value", or "ID" for its typical size. What is wrong goes to `faults`, a line each;
// the text is then unchanged. Expects a bundle that read_bundle takes.
void add_effects(ModelBundle& bundle, const std::vector<std::string>& with, std::vector<std::string>& faults);

}  // namespace omnihil
