#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(WheelRadiusMismatch, ScalesTheRadiusOfItsWheelOnly) {
  const std::vector<double> ratios{1.01, 0.99, 1.02, 0.98};
  for (int wheel = 0; wheel < 4; ++wheel) {
    ContactPort<double> port;
    port.wheel = wheel;
    port.wheel_radius_m = 0.027;
    const double radius_m = called("wheel_radius_mismatch", ratios, port).wheel_radius_m;
    EXPECT_DOUBLE_EQ(radius_m, 0.027 * ratios[static_cast<std::size_t>(wheel)]);
  }
}

double yaw_after(double duty, double path_m, const std::vector<std::string>& effects) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, effects);
  while (std::hypot(plant.truth(0).x_m, plant.truth(0).y_m) < path_m && plant.now_ns() < 10'000'000'000) {
    drive_for(plant, forward(m, duty), 1e-3);
  }
  return plant.truth(0).yaw_rad;
}

// Signature: yaw grows with the path, at any speed alike, to the side of the smaller wheels.
TEST(WheelRadiusMismatch, ShowsAsYawThatGrowsWithTheWayAtAnySpeed) {
  const std::vector<std::string> effects{"wheel_radius_mismatch.ratio_1=1.02",
                                         "wheel_radius_mismatch.ratio_2=1.02"};
  EXPECT_NEAR(yaw_after(0.15, 0.5, {}), 0.0, 1e-9);
  const double slow = yaw_after(0.1, 1.0, effects), fast = yaw_after(0.2, 1.0, effects);
  const double half = yaw_after(0.1, 0.5, effects);
  EXPECT_LT(slow, -0.02);  // the left wheels are larger: it turns right
  EXPECT_NEAR(fast, slow, 0.3 * std::abs(slow));
  EXPECT_NEAR(half, 0.5 * slow, 0.2 * std::abs(slow));
}

}  // namespace
}  // namespace omnihil::test
