// The same duties to a model and to a robot that was recorded: how far apart their paths are (the seed paper's Fig. 9).
//
//   PathTest t = path_test(dataset.runs[0], model, faults);
//   t.rms_m, t.end_m, t.end_rad;
//
// The model starts where the first frames of the recording see the robot, at rest, and then gets the recorded duties,
// nothing else: errors add up, as they do on a floor. `legs` are pieces between two changes of the way's direction.
// Cannot: begin in motion; radio commands instead of duties.
#pragma once
#include <string>
#include <vector>

#include "identify/record/dataset.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

struct PathPoint {
  double time_s = 0, x_m = 0, y_m = 0, yaw_rad = 0;
};

struct PathLeg {
  double from_s = 0, to_s = 0, length_m = 0, rms_m = 0;
};

struct PathTest {
  std::vector<PathPoint> real, model;  // at the recording's frames
  double way_m = 0;                    // of the real one
  double rms_m = 0, most_m = 0, end_m = 0, rms_rad = 0, end_rad = 0;
  std::vector<PathLeg> legs;
};

// What is missing goes to `faults`.
PathTest path_test(const Run& run, const RobotModel& model, std::vector<std::string>& faults);

// Both paths from above, as SVG, under these names.
std::string path_picture(const PathTest& test, const std::string& title, const std::string& real = "real",
                         const std::string& model = "model");

}  // namespace omnihil
