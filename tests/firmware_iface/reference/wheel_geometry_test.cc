// Eq. (5) and its inverse, and what the configuration must allow.
#include "firmware_iface/reference/wheel_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

wheel_geometry geometry_of(const RobotConfig& config) {
  wheel_geometry geometry{};
  EXPECT_EQ(wheel_geometry_init(&geometry, &config), 0);
  return geometry;
}

TEST(WheelGeometry, ForwardAtFortyFiveDegreesIsSpeedOverRadiusOverRootTwo) {
  RobotConfig config = geared_robot().config;
  for (int w = 0; w < kWheels; ++w) config.wheel_angle_rad[w] = degrees(45 + 90 * w);
  const wheel_geometry geometry = geometry_of(config);
  const float body[3] = {1.0f, 0.0f, 0.0f};
  float omega[4];
  body_to_wheels(&geometry, body, omega);
  const double expected = 1.0 / std::sqrt(2.0) / config.wheel_radius_m;
  EXPECT_NEAR(omega[0], -expected, 1e-4);  // front left turns clockwise about the body's centre
  EXPECT_NEAR(omega[1], -expected, 1e-4);
  EXPECT_NEAR(omega[2], expected, 1e-4);
  EXPECT_NEAR(omega[3], expected, 1e-4);
}

TEST(WheelGeometry, TurningMovesEveryWheelAtBodyRateTimesRadiusRatio) {
  const RobotConfig config = direct_robot().config;
  const wheel_geometry geometry = geometry_of(config);
  const float body[3] = {0.0f, 0.0f, 2.0f};
  float omega[4];
  body_to_wheels(&geometry, body, omega);
  for (float wheel : omega)
    EXPECT_NEAR(wheel, 2.0 * config.wheel_center_radius_m / config.wheel_radius_m, 1e-5);
}

TEST(WheelGeometry, EstimateInvertsTheKinematics) {
  for (const RobotConfig& config : {geared_robot().config, direct_robot().config}) {
    const wheel_geometry geometry = geometry_of(config);
    const float body[3] = {1.3f, -0.7f, 4.0f};
    float omega[4], back[3];
    body_to_wheels(&geometry, body, omega);
    wheels_to_body(&geometry, omega, back);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(back[axis], body[axis], 2e-6 * 5);
  }
}

TEST(WheelGeometry, WheelTorquesAddUpToTheWrench) {
  const RobotConfig config = direct_robot().config;
  const wheel_geometry geometry = geometry_of(config);
  const float wrench[3] = {5.0f, -3.0f, 0.2f};
  float torque[4];
  wrench_to_wheel_torques(&geometry, wrench, torque);
  // forces on the body: sum over wheels of rim force along the wheel's tangent (-sin, cos), lever R_b
  double sum[3] = {};
  for (int w = 0; w < kWheels; ++w) {
    const double force_N = torque[w] / config.wheel_radius_m;
    sum[0] -= force_N * std::sin(config.wheel_angle_rad[w]);
    sum[1] += force_N * std::cos(config.wheel_angle_rad[w]);
    sum[2] += force_N * config.wheel_center_radius_m;
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(sum[axis], wrench[axis], 1e-5);
}

TEST(WheelGeometry, ScalingKeepsTheDirection) {
  float omega[4] = {40.0f, -80.0f, 20.0f, 0.0f};
  scale_to_limit(omega, 20.0f);
  const float expected[4] = {10.0f, -20.0f, 5.0f, 0.0f};
  for (int w = 0; w < kWheels; ++w) EXPECT_FLOAT_EQ(omega[w], expected[w]);
}

TEST(WheelGeometry, RefusesFourWheelsThatPointOneWay) {
  RobotConfig config = geared_robot().config;
  for (double& angle : config.wheel_angle_rad) angle = degrees(30);
  wheel_geometry geometry{};
  EXPECT_NE(wheel_geometry_init(&geometry, &config), 0);
}

}  // namespace
}  // namespace omnihil::test
