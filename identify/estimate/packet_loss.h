// Which of the commands that a host sent did not arrive, by what the robot's wheels did.
//
//   LostPackets lost = lost_packets(model, run);      // model: RobotModelValues<double>, run: RobotRun
//   lost.rows.size(), lost.tried;
//
// A host's log has what it sent. A lost command leaves the robot at the one before until the next, which no model without
// that can follow: at a loss of 2 % the wheels' speeds are off by several times their noise. Of the commands that say
// something new, one and the three that follow it are tried with none, one or two of them lost, over the time in which
// their answers die out; the first is lost where the most probable of those sets has it. Decided forward in time, each on
// the motion that the decisions before it gave (decision feedback: Austin 1967). The log of a set's probability is
//     - S / (2 tau) + n log(p / (1 - p)) + constant
// S: sum of squares of measured less simulated wheel speeds over sigma, the larger of the sensor's noise and 1.48 median
// |residual| of the whole run; tau = (1 + r) / (1 - r): samples that are worth one, at a correlation r of successive
// residuals (Bartlett 1946); n: how many are lost; p: share of packets lost before anything is known.
// Cannot tell: a lost command that repeats the one before (no loss to the model either); robots that report no wheel
// speeds; with a firmware in the loop (its state cannot be gone back to): none are lost then.
#pragma once
#include <vector>

#include "identify/predict/robot_signals.h"

namespace omnihil {

struct LostPackets {
  std::vector<std::size_t> rows;  // of the run, ascending
  std::size_t tried = 0;          // commands that said something new

  double share() const {
    return tried == 0 ? 0.0 : static_cast<double>(rows.size()) / static_cast<double>(tried);
  }
};

LostPackets lost_packets(const RobotModelValues<double>& model, const RobotRun& run);

}  // namespace omnihil
