#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(FloorTilt, PullsDownhillAtTheCentreOfMass) {
  BodyPort<double> port;
  port.mass_kg = 2.5;
  port.yaw_rad = 0.3;
  port.center_of_mass_x_m = 0.01;
  const double force_N = 2.5 * 9.80665 * std::sin(0.02);
  const auto out = called("floor_tilt", {0.02, 0.3 + std::numbers::pi / 2}, port);
  EXPECT_NEAR(out.force_x_N, 0.0, 1e-15);
  EXPECT_NEAR(out.force_y_N, force_N, 1e-15);
  EXPECT_NEAR(out.torque_z_Nm, 0.01 * force_N, 1e-15);
}

TEST(FloorTilt, IsConservative) {
  // The force in the field does not depend on the yaw angle.
  for (const double yaw : {0.0, 1.0, -2.5}) {
    BodyPort<double> port;
    port.mass_kg = 2.0;
    port.yaw_rad = yaw;
    const auto out = called("floor_tilt", {0.05, 0.7}, port);
    const double x = std::cos(yaw) * out.force_x_N - std::sin(yaw) * out.force_y_N;
    const double y = std::sin(yaw) * out.force_x_N + std::cos(yaw) * out.force_y_N;
    EXPECT_NEAR(std::atan2(y, x), 0.7, 1e-12);
  }
}

// Signature: coasting from rest the robot drifts downhill in the field, whatever way it looks.
TEST(FloorTilt, ShowsAsADriftThatKeepsItsDirectionInTheField) {
  RobotModel m = frictionless_motor(symmetric_robot());
  m.tyre_lateral.extremum_value = m.tyre_lateral.asymptote_value = 0.0;
  const double spin = m.wheel_inertia_kg_m2 + 9.0 * m.motor.rotor_inertia_kg_m2;
  for (const double yaw : {0.0, std::numbers::pi, 2.0}) {
    Plant plant = floor_with(m, {"floor_tilt.angle_rad=0.02", "floor_tilt.direction_rad=0.8"});
    plant.set_pose(0, 0.0, 0.0, yaw);
    drive_for(plant, RobotDrive{}, 1.0);
    const RobotTruth t = plant.truth(0);
    // between g sin(angle) t^2 / 2 with the wheels' spin on all four and without
    const double distance = std::hypot(t.x_m, t.y_m), free = 0.5 * 9.80665 * std::sin(0.02);
    EXPECT_LT(distance, free);
    EXPECT_GT(distance, 0.95 * free / (1.0 + 4.0 * spin / (m.mass_kg * m.wheel_radius_m * m.wheel_radius_m)));
    EXPECT_NEAR(std::atan2(t.y_m, t.x_m), 0.8, 0.2) << "yaw " << yaw;
  }
}

}  // namespace
}  // namespace omnihil::test
