// Chip kick: speed and angle of the ball from the kick's power and the ball's place on the front, by the seed paper's
// network (two layers, 12 and 2 neurons), trained from a team's table; and the flight that follows.
//
//   ChipKick kick = chip_kick(kDefaultChip, 6.0, 0.01);             // k = 6, 1 cm to the left of the middle
//   double away_m = chip_distance_m(kick, 0.0, 1.2);             // first landing, no drag
//   ChipTraining training = train_chip(table, {});               // of points (k, y, speed, angle)
//
// Network: h = tanh(W1 x + b1), o = W2 h + b2; x, o scaled to -1 … 1 over the table's ranges.
// Training: Levenberg-Marquardt (ceres::TinySolver) on all outputs, from seeded weights.
// The default is trained on a stated ballistic model, since the paper prints no table: speed 0.75 k (1 - (y / 0.06)^2)
// in m/s, angle 45 - 0.6 k - 5 (y / 0.03)^2 degrees, k in 0 … 8 (guess: real ones are measured).
// Source: Bakhshandeh and Sharbafi 2012, III.A ("two layers MLP with 12 and 2 neurons in each layer").
// Cannot: go beyond its table (inputs are held to its ranges), the ball's spin, side angle.
#pragma once
#include <cstdint>
#include <span>

#include "sim/robot/ball_handling.h"

namespace omnihil {

struct ChipKick {
  double speed_m_s = 0.0, angle_rad = 0.0;
};
ChipKick chip_kick(const ChipNetwork& network, double k, double y_m);
// Level ground, no air; height: from where it starts, over where it lands.
double chip_distance_m(const ChipKick& kick, double height_m, double clear_height_m = 0.0);
double chip_apex_m(const ChipKick& kick);

struct ChipPoint {
  double k = 0, y_m = 0, speed_m_s = 0, angle_rad = 0;
};
struct ChipTraining {
  ChipNetwork network;
  double speed_rms_m_s = 0, angle_rms_rad = 0;
  int iterations = 0;
};
struct ChipTrainingOptions {
  std::uint64_t seed = 1;
  int most_iterations = 300;
  int starts = 3;  // the best of them
};
// Throws std::invalid_argument with fewer points than half the weights (31), or values that are not finite.
ChipTraining train_chip(std::span<const ChipPoint> table, const ChipTrainingOptions& options);
ChipPoint ballistic_chip(double k, double y_m);  // the stated model

}  // namespace omnihil
