#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveParams<double> servo() {
  DriveParams<double> p = small_drive();
  p.servo_kp_duty_per_rad = 0.1;
  return p;
}

// 5 rad/s over 1 ms: 5 mrad; the mean over the sub-step is half of it.
TEST(TargetSpeedLimit, WalksAtItsRateFromWhereTheAxisStands) {
  CommandPort<double> port;
  port.kind = CommandKind::kPositionTarget;
  port.position_rad = 0.3;
  port.dt_s = 1e-3;
  double inverse = 0.2, state[2] = {0.0, 0.0};
  const auto law = find_effect("target_speed_limit")->simulate.command;
  port.setpoint = 1.0;
  law(nullptr, &inverse, state, port);
  EXPECT_NEAR(port.setpoint, 0.3025, 1e-12);
  port.setpoint = 1.0;
  law(nullptr, &inverse, state, port);
  EXPECT_NEAR(port.setpoint, 0.3075, 1e-12);
}

TEST(TargetSpeedLimit, FollowsAtOnceInTheLimit) {
  AxisInput in = excite(Excitation::kSteps, 1.0, 2.0);
  in.kind = CommandKind::kPositionTarget;
  const auto jumps = run_axis(servo(), nothing(), in);
  const auto fast = run_axis(servo(), with({use_of("target_speed_limit", {1e-9})}), in);
  for (std::size_t n = 0; n < fast.size(); ++n)
    EXPECT_NEAR(fast[n].position_rad, jumps[n].position_rad, 1e-9);
}

TEST(TargetSpeedLimit, LeavesSlowerTargetsAlone) {
  AxisInput in = held(CommandKind::kPositionTarget, 0.0, 2.0);
  for (std::size_t n = 0; n < in.time_s.size(); ++n) in.command[n] = 2.0 * in.time_s[n];
  // Held per sample, a target of 2 rad/s jumps by 2 mrad, which 5 rad/s walks within 0.4 ms.
  const auto jumps = run_axis(servo(), nothing(), in);
  const auto limited = run_axis(servo(), with({use_of("target_speed_limit", {0.2})}), in);
  for (std::size_t n = 0; n < limited.size(); ++n) {
    EXPECT_NEAR(limited[n].position_rad, jumps[n].position_rad, 2e-3);
  }
}

// Signature: the same slope of the position for every size of a large step, its sign with the step's.
TEST(TargetSpeedLimit, ShowsAsOneSlopeForEverySizeOfStep) {
  for (const double step : {10.0, 20.0, -20.0}) {
    const AxisInput in = held(CommandKind::kPositionTarget, step, 2.0);
    const auto out = run_axis(servo(), with({use_of("target_speed_limit", {0.2})}), in);
    const double slope = (out[1900].position_rad - out[1500].position_rad) / 0.4;
    EXPECT_NEAR(slope, std::copysign(5.0, step), 0.01) << step;
  }
}

}  // namespace
}  // namespace omnihil::test
