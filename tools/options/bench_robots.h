// The tables of a bench file that are of single robots: `[[robot]]` and `[[fault]]`, as options of serve.
//
//   [[robot]]                          # --robots, --robot-of, --firmware-of, --with-of, --start
//   id = 3
//   team = "yellow"                    # another than the bench's: an opponent
//   model = "my_robot.toml"
//   firmware = "image.elf"
//   board = "board.toml"
//   with = ["battery_sag"]
//   x_m = 1.5
//   y_m = -0.5
//   yaw_deg = 90
//   [[fault]]                          # --fault
//   robots = "0,3"
//   at_s = 5.0
//   do = "wheel_blocked"               # the words of scenarios
//   wheels = [0]
//
// Rows that are good become arguments; what is wrong with the others stands in the problems, with file and line.
#pragma once
#include <toml++/toml.h>

#include <functional>
#include <string>
#include <vector>

#include "hil/text/toml_keys.h"

namespace omnihil {

struct BenchRows {
  std::vector<std::string> own, opponents;  // ids of [[robot]] tables
  std::vector<std::string> arguments;       // "--robot-of=3=ulaval_2024"
};

// `beside`: a file's name as it is found from the bench's folder.
BenchRows bench_rows(const ModelDocument& document,
                     const std::function<std::string(const std::string&)>& beside,
                     std::vector<ModelProblem>& problems);

}  // namespace omnihil
