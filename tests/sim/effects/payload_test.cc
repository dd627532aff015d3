#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(Payload, AddsItsMassAndTheInertiaOfTheSameShape) {
  BodyPort<double> port;
  port.mass_kg = 2.0;
  port.yaw_inertia_kg_m2 = 0.01;
  const auto out = called("payload", {0.5}, port);
  EXPECT_DOUBLE_EQ(out.mass_kg, 2.5);
  EXPECT_NEAR(out.yaw_inertia_kg_m2 / out.mass_kg, 0.01 / 2.0, 1e-17);
}

// Signature: the same currents accelerate less, by masses and what spins with the wheels.
TEST(Payload, ShowsAsLessAccelerationOnTheFloor) {
  RobotModel m = frictionless_motor(symmetric_robot());
  m.tyre_lateral.extremum_value = m.tyre_lateral.asymptote_value = 0.0;
  m.motor.current_limit_A = 1.0;  // so that the torque is the same at every speed
  const auto speed = [&](const std::vector<std::string>& effects) {
    Plant plant = floor_with(m, effects);
    drive_for(plant, forward(m, 0.4), 0.05);  // slip has settled
    const double before = plant.truth(0).v_forward_m_s;
    drive_for(plant, forward(m, 0.4), 0.1);
    return plant.truth(0).v_forward_m_s - before;
  };
  const double spin = m.wheel_inertia_kg_m2 + 9.0 * m.motor.rotor_inertia_kg_m2;
  double sin2 = 0.0;
  for (const double a : m.wheel_angle_rad) sin2 += std::sin(a) * std::sin(a);
  const double turning_kg = sin2 * spin / (m.wheel_radius_m * m.wheel_radius_m);
  EXPECT_NEAR(speed({"payload.mass_kg=0.6"}) / speed({}),
              (m.mass_kg + turning_kg) / (m.mass_kg + 0.6 + turning_kg), 0.01);
}

TEST(Payload, StandsOnTheWheels) {
  const RobotModel m = symmetric_robot();
  const RobotTruth t = floor_with(m, {"payload.mass_kg=0.6"}).truth(0);
  EXPECT_NEAR(t.load_N[0] + t.load_N[1] + t.load_N[2] + t.load_N[3], (m.mass_kg + 0.6) * 9.80665, 1e-9);
}

}  // namespace
}  // namespace omnihil::test
