// Two robots pass and score over a lossy radio and a late, noisy camera: the seed paper's combinational test.
//
//   PassResult r = play_pass_and_shoot(model, MotorLoop::kEmotional, {.seed = 7});
//   r.received; r.scored; r.wheel_rms_rad_s;
//
// Robot 0 goes around the ball until robot 1 is behind it, and kicks so that the ball arrives at kArrives_m_s; robot 1 goes
// onto the ball's line, gives way a little as it comes, takes it, goes around it in its turn and shoots at the goal. What the host
// knows comes from frames of 60 Hz with delay and noise (hil/league/vision.h), and nothing else; what robots
// get goes through a radio that loses packets by distance (hil/loop/air_loss.h). Places are drawn from the seed.
// The high level is the same for every wheel controller, and knows none of them.
// Cannot: opponents; a second try.
#pragma once
#include <cstdint>

#include "hil/loop/field_trace.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

struct PassOptions {
  std::uint64_t seed = 1;
  double delay_least_s = 0.006, delay_most_s = 0.024;  // of the camera: the paper's
  double position_sigma_m = 0.002, yaw_sigma_rad = 0.01;
  FieldTrace** trace = nullptr;  // not null: of what happened, owned by the caller
};

struct PassResult {
  bool kicked = false, received = false, scored = false;
  double pass_s = 0.0, goal_s = 0.0;  // from the start; 0: it did not come to it
  double wheel_rms_rad_s = 0.0;       // wheels' speeds against what the commands ask of them, both robots
};

PassResult play_pass_and_shoot(const RobotModel& model, MotorLoop loop, const PassOptions& options);

// Share of `yes` in `of` with its 95 % interval (Wilson 1927).
struct Share {
  double share = 0.0, from = 0.0, to = 0.0;
};
Share wilson_share(int yes, int of);

// Two-sided p-value of McNemar's exact test: of pairs that differ, `only_first` for the first and `only_second` for the
// second, under no difference each as likely (McNemar 1947).
double mcnemar_p(int only_first, int only_second);

}  // namespace omnihil
