// A run that nobody has recorded yet, as a predictor: planned inputs, and a model's answer as the
// measurement.
//
//   PlannedBench bench = planned_bench(dataset, nominal);
//   auto world = planned_world(bench, run, truth);          // run.drive: what is asked, in the input's unit
//   MotionExtremes m = planned_extremes(bench, run, model);  // current, speed and travel, simulated
//
// Sensors, their noise, the clock of the camera and the bus voltage are those of the given data.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

struct PlannedInputs {
  std::vector<double> time_s;
  std::vector<std::vector<double>> drive;  // one, or one per wheel
};

struct PlannedBench {
  Dataset like;  // channels as given, noise filled in; no runs
  Run example;   // a run of the given data: which signals there are
  Candidate nominal;
  std::vector<std::string> inputs;  // "duty"; "duty_1" …
  double full_input = 1.0;          // what 1 of an excitation means
  double supply_V = 0.0;
  double camera_period_s = 0.0;  // 0: none
  std::string problem;           // why nothing can be planned; empty: it can
};

PlannedBench planned_bench(const Dataset& given, const Candidate& nominal, const Predictor& predictor);

std::unique_ptr<Predictor> planned_world(const PlannedBench& bench, const PlannedInputs& run,
                                         const Candidate& truth, std::uint64_t seed);

struct MotionExtremes {
  double current_A = 0.0;
  double rotor_speed_rad_s = 0.0;  // of a linear axis m/s
  double travel = 0.0;             // rad at the output; m of a linear axis or a robot
  bool finite = true;
};
MotionExtremes planned_extremes(const PlannedBench& bench, const PlannedInputs& run, const Candidate& model);

}  // namespace omnihil
