// Signals of rig "robot" that a model is compared with: measured, predicted, their noise, and the regime
// variables.
//
//   std::vector<RobotSignal> s = robot_signals(dataset, run, record);
//   std::vector<double> y = robot_signal_values(s[0], record, motion);    // on the clock of s[0].compared
//
// bus_voltage, where measured, is an input of the model; its drop is compared with the model supply's, means
// made equal (the level drifts with the battery). velocity_i is the difference of the encoder's counts from
// sample to sample, on the rotor, on both sides.
#pragma once
#include "identify/predict/predictor.h"
#include "identify/predict/robot_motion.h"

namespace omnihil {

enum class RobotOutput : std::uint8_t {
  kVelocity,
  kWheelSpeed,
  kCurrent,
  kGyro,
  kAccelX,
  kAccelY,
  kVisionX,
  kVisionY,
  kVisionTheta,
  kForceX,
  kForceY,
  kBusVoltage
};

struct RobotSignal {
  RobotOutput output = RobotOutput::kVelocity;
  std::size_t wheel = 0;
  std::string channel;         // name of the dataset's channel that it comes from
  double channel_sigma = 0.0;  // of the channel's own noise, in its unit: stated, or estimated
  ComparedSignal compared;
};

std::vector<RobotSignal> robot_signals(const Dataset& dataset, const Run& run, const RobotRecord& record);

// Adds to the noise of each signal the response to the inputs' noise: `perturbed` is the same model on the
// record with_input_noise. No model can pass that floor.
void add_input_noise(const RobotRecord& record, const RobotMotion<double>& motion,
                     const RobotMotion<double>& perturbed, std::vector<RobotSignal>& signals);

template <typename T>
std::vector<T> robot_signal_values(const RobotSignal& signal, const RobotRecord& record,
                                   const RobotMotion<T>& motion);

std::vector<RegimeTrack> robot_regimes(const Run& run, const RobotRecord& record,
                                       const RobotMotion<double>& motion);

// Puts the sensors' readings of `motion` into `run`, with their noise drawn from `seed`: counts whole, frames
// where there were frames, gaps where there were gaps.
void measure_robot(const RobotRecord& record, const RobotMotion<double>& motion,
                   const std::vector<RobotSignal>& signals, std::uint64_t seed, Run& run);
// Bus voltage of a simulated recording: the model supply's, with its sensor's noise.
void measure_robot_bus(const RobotRecord& record, const RobotMotion<double>& motion, std::uint64_t seed,
                       RobotSignal& signal);

}  // namespace omnihil
