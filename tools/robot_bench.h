// A whole robot on the floor as a virtual test bench: behind `omnihil sim ROBOT --rig robot`.
//
//   std::vector<std::string> faults;
//   std::optional<RobotBench> bench = make_robot_bench(options, faults);    // none: every fault is in `faults`
//   folder.write(bench->files[0].name, bench->files[0].text);               // dataset.toml, model.toml, runs
//
// Duties of an excitation by name change no faster than half of the tyre's grip lets the robot follow; a file's are taken as they are.
// An excitation by name drives forward, sideways and turn at once, each by a pattern of its own; the held-out
// run has other patterns and 0.8 of the amplitude. A CSV file gives time and a duty per wheel, or time and one
// duty that is driven straight ahead; its last third is held out.
// Sensors are those of the plant with white noise of a known size on top; a camera frame comes 60 times a
// second. The model that goes with the data is the nominal one: effects added for this run are what the data
// are to show.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/dataset/dataset_export.h"
#include "tools/axis_bench.h"

namespace omnihil {

struct RobotBench {
  std::vector<DatasetFile> files;
  std::size_t rows = 0;
  std::size_t runs = 0;
  std::string diverged;  // which run and where; empty: none did
};

std::optional<RobotBench> make_robot_bench(const BenchOptions& options, std::vector<std::string>& faults);

}  // namespace omnihil
