// The model run on the commands that a robot gets, beside it, piece by piece: what telemetry should say, and how each fault would
// change that.
//
//   TwinModel twin(twin_bank(model));
//   TwinWindow w = twin.advance(piece);                   // a Run: rows of commands and telemetry; first row = last one's last
//   w.signals[0].measured[k] - w.signals[0].expected[k];
//   w.signals[0].gains(k, f);                             // d expected / d size of fault f, exact, through the closed loop
//
// The motion goes on from piece to piece (RobotCarry): a loop under commands forgets its start and does not drift, so it is
// never put right by what it is compared with, which would hide a fault. Compared: wheel speeds, currents, gyro, bus voltage,
// where they are told. Poses are not: they do drift. A bus voltage's level is the battery's charge, which no model knows: its
// difference and gains are high-passed twice, so that a level that falls evenly leaves nothing.
// Needs a robot that is asked for velocities, and a model with [controller] and effects.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "identify/predict/robot_motion.h"
#include "identify/predict/robot_signals.h"
#include "identify/twin/twin_faults.h"

namespace omnihil {

struct TwinSignal {
  std::string name, unit;
  bool wheel_speed = false;
  std::vector<double> time_s, measured, expected;  // n told samples
  std::vector<double> slope;                       // of the expected value, per s
  Eigen::MatrixXd gains;                           // n x faults
};

struct TwinWindow {
  double from_s = 0.0, to_s = 0.0;
  std::vector<TwinSignal> signals;  // those that the robot tells, in one order
  double moved_rad_s = 0.0;         // rms of the expected wheel speeds
  bool finite = true;
};

class TwinModel {
 public:
  explicit TwinModel(TwinBank bank);
  // Rows that were not yet there, behind the last row of the piece before. `piece` is in the model's signals.
  TwinWindow advance(const Run& piece);
  const TwinBank& bank() const { return bank_; }
  void restart();  // from telemetry, after a pause

 private:
  // First-order low pass of what was told less what was expected, and of that over the faults.
  struct Level {
    double gap = 0.0;
    Eigen::VectorXd gains;
  };
  void take_level(TwinSignal& bus);
  TwinBank bank_;
  std::vector<Unknown> unknowns_;
  std::vector<RobotModelValues<Jet>> models_;  // kJetWidth faults each
  std::vector<RobotCarry<Jet>> carries_;
  std::vector<Level> levels_;  // the second of what the first leaves
  double level_from_s_ = 0.0, level_last_s_ = 0.0;
};

// "" or why a model cannot be a twin.
std::string twin_refusal(const Candidate& model);

}  // namespace omnihil
