#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(LateralRollerFriction, TakesItsShareOfTheLoadAgainstTheMotion) {
  ContactPort<double> port;
  port.load_N = 6.0;
  port.v_lateral_m_s = 0.02;  // the smoothing speed: 1 / sqrt(2) of the full force
  EXPECT_NEAR(called("lateral_roller_friction", {0.05}, port).force_lateral_N, -0.3 / std::sqrt(2.0), 1e-15);
  port.v_lateral_m_s = -2.0;
  EXPECT_NEAR(called("lateral_roller_friction", {0.05}, port).force_lateral_N, 0.3, 1e-4);
}

TEST(LateralRollerFriction, IsNotThereAtRestNorWithoutLoad) {
  ContactPort<double> port;
  port.load_N = 6.0;
  EXPECT_EQ(called("lateral_roller_friction", {0.05}, port).force_lateral_N, 0.0);
  port.load_N = 0.0;
  port.v_lateral_m_s = 1.0;
  EXPECT_EQ(called("lateral_roller_friction", {0.05}, port).force_lateral_N, 0.0);
}

// Signature: thrown with free wheels the robot slows in every direction; the loss of speed is that of
// friction, mu g times the mean of |cos| over the axles.
TEST(LateralRollerFriction, ShowsAsASlowingThatDependsOnTheDirectionOfTravel) {
  RobotModel m = frictionless_motor(symmetric_robot());
  m.wheel_angle_rad = {0.0, std::numbers::pi / 2, std::numbers::pi, -std::numbers::pi / 2};
  m.tyre_lateral.extremum_value = m.tyre_lateral.asymptote_value = 0.0;
  const auto lost = [&](bool diagonal, const std::vector<std::string>& effects) {
    Plant plant = floor_with(m, effects);
    RobotDrive d = forward(m, 0.2);
    const RobotDrive side = sideways(m, 0.2);
    for (std::size_t i = 0; i < kWheels && diagonal; ++i) d.duty_ratio[i] += side.duty_ratio[i];
    drive_for(plant, d, 1.0);
    const RobotTruth before = plant.truth(0);
    drive_for(plant, RobotDrive{}, 0.2);
    const RobotTruth after = plant.truth(0);
    return std::hypot(before.v_forward_m_s, before.v_left_m_s) -
           std::hypot(after.v_forward_m_s, after.v_left_m_s);
  };
  const std::vector<std::string> with{"lateral_roller_friction.coefficient=0.08"};
  const double along = lost(false, with) - lost(false, {}), diagonal = lost(true, with) - lost(true, {});
  // two of four wheels roll sideways: mu g / 2; on the diagonal all four at 45 degrees: mu g / sqrt(2). The
  // wheels' spin goes on turning with the robot and adds to its mass.
  const double spin = m.wheel_inertia_kg_m2 + 9.0 * m.motor.rotor_inertia_kg_m2;
  const double heavier = 1.0 + 2.0 * spin / (m.mass_kg * m.wheel_radius_m * m.wheel_radius_m);
  // the root of the law takes about two percent at this speed
  EXPECT_NEAR(along, 0.2 * 0.08 * 9.80665 / 2.0 / heavier, 0.03 * along);
  EXPECT_NEAR(diagonal / along, std::sqrt(2.0), 0.02);
}

}  // namespace
}  // namespace omnihil::test
