#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(DribblerDrag, OpposesTheMotionWhileTheDribblerTurns) {
  BodyPort<double> port;
  port.v_forward_m_s = 3.0;
  port.v_left_m_s = -4.0;
  port.dribbler_rad_s = 20.0;  // 1 / sqrt(2) of the force
  const auto out = called("dribbler_drag", {0.5}, port);
  const double force_N = 0.5 / std::sqrt(2.0);
  EXPECT_NEAR(out.force_x_N, -0.6 * force_N, 1e-4);
  EXPECT_NEAR(out.force_y_N, 0.8 * force_N, 1e-4);
}

TEST(DribblerDrag, IsNotThereWithTheDribblerOffNorAtRest) {
  BodyPort<double> port;
  port.dribbler_rad_s = 500.0;
  EXPECT_EQ(called("dribbler_drag", {0.5}, port).force_x_N, 0.0);
  port.dribbler_rad_s = 0.0;
  port.v_forward_m_s = 1.0;
  EXPECT_EQ(called("dribbler_drag", {0.5}, port).force_x_N, 0.0);
}

// Signature: the steady speed falls when the dribbler is switched on and comes back when it is off.
TEST(DribblerDrag, ShowsAsALossOfSpeedThatGoesWithTheDribbler) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"dribbler_drag.force_N=1.5"});
  RobotDrive d = forward(m, 0.15);
  std::array<double, 3> speed{};
  const std::array<double, 3> ratio{0.0, 1.0, 0.0};
  std::array<double, 3> current{};
  for (std::size_t phase = 0; phase < 3; ++phase) {
    d.dribbler_ratio = ratio[phase];
    drive_for(plant, d, 1.5);
    speed[phase] = plant.truth(0).v_forward_m_s;
    for (const double i : plant.truth(0).motor_current_A) current[phase] += std::abs(i);
  }
  EXPECT_LT(speed[1], speed[0] - 0.003);
  EXPECT_NEAR(speed[2], speed[0], 1e-4);
  // F v = gear k sum(i omega): four wheels at 60 and 135 degrees share by sin
  EXPECT_GT(current[1], current[0] + 0.2);
}

}  // namespace
}  // namespace omnihil::test
