#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(RollingResistance, AddsALevelOfItsShareOfTheLoadAtTheRadius) {
  ContactPort<double> port;
  port.load_N = 6.0;
  port.wheel_radius_m = 0.027;
  EXPECT_NEAR(called("rolling_resistance", {0.02}, port).friction_wheel_Nm, 0.02 * 6.0 * 0.027, 1e-17);
  port.load_N = 0.0;
  EXPECT_EQ(called("rolling_resistance", {0.02}, port).friction_wheel_Nm, 0.0);
}

// Signature: more current at the same steady speed, the floor's share of it c N r / (gear k) per wheel.
TEST(RollingResistance, ShowsAsCurrentAtSteadySpeedInProportionToTheLoad) {
  const RobotModel m = symmetric_robot();
  const auto current = [&](const std::vector<std::string>& effects) {
    Plant plant = floor_with(m, effects);
    drive_for(plant, duty_drive({0.2, 0.2, 0.2, 0.2}), 3.0);  // on the spot
    const RobotTruth t = plant.truth(0);
    double sum = 0.0;
    for (std::size_t i = 0; i < kWheels; ++i) sum += t.motor_current_A[i];
    return std::pair(sum, t.omega_rotor_rad_s[0]);
  };
  const auto [without, speed] = current({});
  const auto [with, slower] = current({"rolling_resistance.coefficient=0.03"});
  const double weight_N = m.mass_kg * 9.80665, gear_k = m.gear_ratio * m.motor.torque_constant_Nm_per_A;
  const double viscous = kWheels * m.motor.viscous_friction_Nm_s_per_rad / m.motor.torque_constant_Nm_per_A;
  EXPECT_NEAR(with - without + viscous * (speed - slower), 0.03 * weight_N * m.wheel_radius_m / gear_k, 2e-3);
}

TEST(RollingResistance, HoldsWheelsThatThePushOfTheMotorDoesNotBreakAway) {
  const RobotModel m = frictionless_motor(symmetric_robot());
  Plant plant = floor_with(m, {"rolling_resistance.coefficient=0.1"});
  // level 0.1 N r / gear: 4.4 mN m on the light wheels, 6.2 on the heavy ones; the motors give
  // duty x 24 V / 0.464 ohm x 25.5 mN m/A: 4.0 mN m first, then 7.9
  drive_for(plant, duty_drive({0.003, 0.003, 0.003, 0.003}), 0.5);
  for (const double w : plant.truth(0).omega_wheel_rad_s) EXPECT_EQ(w, 0.0);
  drive_for(plant, duty_drive({0.006, 0.006, 0.006, 0.006}), 0.5);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(plant.truth(0).omega_wheel_rad_s[i], 0.0);
}

}  // namespace
}  // namespace omnihil::test
