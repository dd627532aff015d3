// What rig "robot" is compared with: which of its channels see what of its motion; the regime variables; readings of a
// simulated motion.
//
//   RobotRun r = robot_run(dataset, run, nominal);
//   std::vector<double> y = robot_signal_values(r, 0, motion);    // on the clock of r.compared[0], before complete()
//
// bus_voltage, where measured, is an input of the model; its drop is compared with the model supply's, means
// made equal (the level drifts with the battery). velocity_i is the difference of the encoder's counts, on the rotor, on
// both sides.
#pragma once
#include "identify/predict/observation.h"
#include "identify/predict/robot_motion.h"

namespace omnihil {

struct RobotRun : RigRun {
  RobotRecord record;
};
RobotRun robot_run(const Dataset& dataset, const Run& run, const RollingParams<double>& nominal);

// Adds to the noise of each signal the response to the inputs' noise: `perturbed` is the same model on the
// record with_input_noise. No model can pass that floor.
void add_input_noise(const RobotMotion<double>& motion, const RobotMotion<double>& perturbed, RobotRun& run);

template <typename T>
std::vector<T> robot_signal_values(const RobotRun& run, std::size_t signal, const RobotMotion<T>& motion);

std::vector<RegimeTrack> robot_regimes(const Run& run, const RobotRecord& record,
                                       const RobotMotion<double>& motion);

// Puts the sensors' readings of `motion` into `made`, with their noise drawn from `seed`: counts whole, frames
// where there were frames, gaps where there were gaps. The bus voltage is an input: its true values with their sensor's
// noise; what is compared of it is the model supply's, with noise of its own.
void measure_robot(const RobotRun& run, const RobotMotion<double>& motion, std::uint64_t seed, Run& made);
void measure_compared_bus(const RobotMotion<double>& motion, std::uint64_t seed, RobotRun& run);

}  // namespace omnihil
