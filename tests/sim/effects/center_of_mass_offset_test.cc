#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(CenterOfMassOffset, MovesTheCentreAndKeepsTheInertiaAboutIt) {
  BodyPort<double> port;
  port.mass_kg = 2.0;
  port.yaw_inertia_kg_m2 = 0.01;
  port.center_of_mass_x_m = 0.003;
  const auto out = called("center_of_mass_offset", {0.01, -0.02}, port);
  EXPECT_NEAR(out.center_of_mass_x_m, 0.013, 1e-17);
  EXPECT_NEAR(out.center_of_mass_y_m, -0.02, 1e-17);
  const double about_centre = out.yaw_inertia_kg_m2 - 2.0 * (0.013 * 0.013 + 0.02 * 0.02);
  EXPECT_NEAR(about_centre, 0.01 - 2.0 * 0.003 * 0.003, 1e-17);
}

// Signature: straight acceleration turns the robot, one way forward and the other way back.
TEST(CenterOfMassOffset, ShowsAsYawWhoseSignFollowsTheAcceleration) {
  const RobotModel m = symmetric_robot();
  const auto yaw = [&](double duty, const std::vector<std::string>& effects) {
    Plant plant = floor_with(m, effects);
    drive_for(plant, forward(m, duty), 0.1);
    return plant.truth(0).yaw_rad;
  };
  const std::vector<std::string> left{"center_of_mass_offset.y_m=0.01"},
      right{"center_of_mass_offset.y_m=-0.01"};
  EXPECT_NEAR(yaw(0.2, {}), 0.0, 1e-12);
  EXPECT_GT(std::abs(yaw(0.2, left)), 1e-4);
  EXPECT_LT(yaw(0.2, left) * yaw(-0.2, left), 0.0);
  EXPECT_NEAR(yaw(0.2, left), -yaw(0.2, right), 1e-9);
}

TEST(CenterOfMassOffset, PutsMoreLoadOnTheWheelsItMovesTo) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"center_of_mass_offset.x_m=0.01"});
  const RobotTruth t = plant.truth(0);
  EXPECT_GT(t.load_N[0], t.load_N[1]);  // 60 degrees: in front
  EXPECT_NEAR(t.load_N[0] + t.load_N[1] + t.load_N[2] + t.load_N[3], m.mass_kg * 9.80665, 1e-9);
}

}  // namespace
}  // namespace omnihil::test
