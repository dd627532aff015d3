// Signals of rig "robot" that a model is held against: the measured side, the model's side, the noise, and
// what the motion was like at each sample.
//
//   std::vector<RobotSignal> s = robot_signals(dataset, run, record);
//   std::vector<double> y = robot_signal_values(s[0], record, motion);    // on the clock of s[0].compared
//
// velocity_i is the difference of the encoder's counts from sample to sample, on the rotor, on both sides.
#pragma once
#include "sim/identify/predictor.h"
#include "sim/identify/robot_motion.h"

namespace omnihil {

enum class RobotOutput : std::uint8_t {
  kVelocity,
  kCurrent,
  kGyro,
  kAccelX,
  kAccelY,
  kVisionX,
  kVisionY,
  kVisionTheta
};

struct RobotSignal {
  RobotOutput output = RobotOutput::kVelocity;
  std::size_t wheel = 0;
  std::string channel;         // that it comes from
  double channel_sigma = 0.0;  // of the channel's own noise: stated, or estimated
  ComparedSignal compared;
};

std::vector<RobotSignal> robot_signals(const Dataset& dataset, const Run& run, const RobotRecord& record);

template <typename T>
std::vector<T> robot_signal_values(const RobotSignal& signal, const RobotRecord& record,
                                   const RobotMotion<T>& motion);

std::vector<RegimeTrack> robot_regimes(const Run& run, const RobotRecord& record,
                                       const RobotMotion<double>& motion);

// Puts what the sensors would have shown of `motion` into `run`, with their noise drawn from `seed`: counts
// whole, frames where there were frames, gaps where there were gaps.
void measure_robot(const RobotRecord& record, const RobotMotion<double>& motion,
                   const std::vector<RobotSignal>& signals, std::uint64_t seed, Run& run);

}  // namespace omnihil
