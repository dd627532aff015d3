#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(WheelSlip, AddsItsSlidingSpeedAndLimitsTheGrip) {
  const auto port = called("wheel_slip", {0.1, 0.6}, ContactPort<double>{});
  EXPECT_EQ(port.slip_speed_m_s, 0.1);
  EXPECT_EQ(port.grip_coefficient, 0.6);
}

TEST(WheelSlip, LimitsNothingWithoutCompliance) {
  const auto port = called("wheel_slip", {0.0, 0.1}, ContactPort<double>{});
  EXPECT_EQ(port.slip_speed_m_s, 0.0);
  EXPECT_EQ(port.grip_coefficient, 0.0);
}

// 1 / mu = 1 / mu_0 + (1 / mu_1 - 1 / mu_0) v_c / (10 mm/s), so that a fit feels where the effect begins.
TEST(WheelSlip, ComesInWithoutAJump) {
  ContactPort<double> port;
  EXPECT_NEAR(called("wheel_slip", {0.005, 0.6}, port).grip_coefficient, 1.2, 1e-12);
  port.grip_coefficient = 0.75;
  EXPECT_NEAR(called("wheel_slip", {0.005, 0.5}, port).grip_coefficient, 2.0 / (1.0 / 0.75 + 1.0 / 0.5),
              1e-12);
  EXPECT_NEAR(called("wheel_slip", {1e-9, 0.5}, port).grip_coefficient, 0.75, 1e-6);
  EXPECT_NEAR(called("wheel_slip", {0.01 - 1e-9, 0.5}, port).grip_coefficient, 0.5, 1e-6);
}

TEST(WheelSlip, KeepsTheSmallerGrip) {
  ContactPort<double> port;
  port.grip_coefficient = 0.4;
  EXPECT_EQ(called("wheel_slip", {0.1, 0.6}, port).grip_coefficient, 0.4);
  EXPECT_EQ(called("wheel_slip", {0.1, 0.3}, port).grip_coefficient, 0.3);
}

// Rim speed less the speed of the robot above it, mean of the wheels, 15 ms after a step.
double sliding_m_s(const std::vector<std::string>& effects) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, effects);
  drive_for(plant, forward(m, 0.02), 0.015);
  const RobotTruth t = plant.truth(0);
  double sum = 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double hub = -std::sin(m.wheel_angle_rad[i]) * t.v_forward_m_s;
    sum += std::abs(t.omega_wheel_rad_s[i] * m.wheel_radius_m - hub);
  }
  return sum / kWheels;
}

// Signature: the wheels run ahead of the robot while it accelerates, the more the softer the contact.
TEST(WheelSlip, ShowsAsWheelsFasterThanTheBodyUnderAcceleration) {
  const double base = sliding_m_s({});
  const double soft = sliding_m_s({"wheel_slip.compliance_m_s=0.3", "wheel_slip.grip=2"});
  EXPECT_GT(base, 0.0);
  EXPECT_GT(soft, 2.0 * base);
}

// No wheel pushes harder than its grip allows; the effect's grip is below the base model's 0.75.
TEST(WheelSlip, NeverPushesHarderThanItsGrip) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"wheel_slip.compliance_m_s=0.05", "wheel_slip.grip=0.3"});
  double most = 0.0;
  for (int ms = 0; ms < 200; ++ms) {
    drive_for(plant, forward(m, 0.9), 1e-3);
    const RobotTruth t = plant.truth(0);
    for (std::size_t i = 0; i < kWheels; ++i) {
      most = std::max(most, std::abs(t.force_longitudinal_N[i]) / t.load_N[i]);
    }
  }
  EXPECT_LE(most, 0.3 + 1e-12);
  EXPECT_GT(most, 0.29) << "the drive was not hard";
}

}  // namespace
}  // namespace omnihil::test
