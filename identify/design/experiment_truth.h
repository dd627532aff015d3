// A planned run as a predictor: its inputs, and the simulated response of a model that is taken as the truth
// in place of a measurement.
//
//   PlannedBench bench = planned_bench(dataset, nominal, predictor);
//   auto simulated = simulated_truth(bench, inputs, truth, seed);
//   MotionExtremes m = planned_extremes(bench, inputs, model);  // current, speed and travel, simulated
//
// Sensors, their noise, the clock of the camera and the bus voltage are those of the given data.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

struct PlannedInputs {
  std::vector<double> time_s;              // n samples
  std::vector<std::vector<double>> drive;  // [drive][sample] in the input's unit; one drive, or one per wheel
};

struct PlannedBench {
  Dataset like;  // channels as given, noise sigmas filled in; no runs
  Run example;   // a run of the given data, for the list of its signals
  Candidate nominal;
  std::vector<std::string> inputs;  // "duty"; "duty_1" …; "command_vx" … where radio commands drive
  std::vector<double> input_scale;  // of each input at an excitation's value of 1, over full_input; empty: 1
  double full_input = 1.0;          // input at an excitation's value of 1, in the input's unit
  double supply_V = 0.0;
  double camera_period_s = 0.0;  // 0: none
  // The bench is asked for a motion and its input is what is predicted: `drive` is the speed of the output, which
  // follows with no more acceleration than the given data have.
  bool imposed = false;
  double most_acceleration = 0.0;  // rad/s2; of a linear axis m/s2
  double most_travel = 0.0;        // of the given data, from their starts: rad or m
  std::string problem;             // reason why no run can be planned; empty: none
};

PlannedBench planned_bench(const Dataset& given, const Candidate& nominal, const Predictor& predictor);

// Speed of an imposed motion, n samples: the planned speed within the bench's acceleration.
std::vector<double> imposed_speed(const PlannedBench& bench, const PlannedInputs& run);

std::unique_ptr<Predictor> simulated_truth(const PlannedBench& bench, const PlannedInputs& run,
                                           const Candidate& truth, std::uint64_t seed);

struct MotionExtremes {
  double current_A = 0.0;
  double rotor_speed_rad_s = 0.0;  // of a linear axis m/s
  double travel = 0.0;             // rad at the output; m of a linear axis or a robot
  bool finite = true;
};
MotionExtremes planned_extremes(const PlannedBench& bench, const PlannedInputs& run, const Candidate& model);

}  // namespace omnihil
