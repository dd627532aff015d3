// Friction that really holds still: not one bit of creep below break-away, motion above, never a gain of
// energy.
#include <gtest/gtest.h>

#include <cstring>

#include "sim/robot/wheel_drive.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

class Friction : public testing::TestWithParam<Physics> {
 protected:
  static PlantOptions options() {
    PlantOptions o;
    o.physics = GetParam();
    return o;
  }
};

// Duty whose stall torque k/R u is `part` of the friction torque.
double duty_for_friction(const RobotModel& m, double part) {
  const double volt =
      part * m.motor.coulomb_friction_Nm * m.motor.resistance_ohm / m.motor.torque_constant_Nm_per_A;
  return volt / m.bus_voltage_V;
}

TEST_P(Friction, BelowBreakAwayTheRobotDoesNotCreepByOneBit) {
  const RobotModel m = sample_robot();
  Plant plant = one_robot(m, options());
  plant.set_pose(0, 0.1, -0.2, 0.3);
  const RobotTruth before = plant.truth(0);
  const double duty = duty_for_friction(m, 0.95);
  plant.write(0, duty_drive({duty, -duty, duty, 0.5 * duty}));
  plant.advance(3'000'000'000);
  const RobotTruth after = plant.truth(0);
  EXPECT_EQ(before.x_m, after.x_m);
  EXPECT_EQ(before.y_m, after.y_m);
  EXPECT_EQ(before.yaw_rad, after.yaw_rad);
  for (std::size_t i = 0; i < kWheels; ++i) {
    EXPECT_EQ(after.theta_rotor_rad[i], 0.0);
    EXPECT_EQ(after.omega_rotor_rad_s[i], 0.0);
  }
  // The current flows all the same: u / R.
  EXPECT_NEAR(after.motor_current_A[0], duty * m.bus_voltage_V / m.motor.resistance_ohm, 1e-9);
}

TEST_P(Friction, AboveBreakAwayTheWheelsTurnAndTheRobotMoves) {
  const RobotModel m = sample_robot();
  Plant plant = one_robot(m, options());
  const double duty = duty_for_friction(m, 1.6);
  plant.write(0, duty_drive({duty, duty, duty, duty}));
  plant.advance(2'000'000'000);
  EXPECT_GT(plant.truth(0).yaw_rad, 0.1);
}

TEST_P(Friction, AShortedRobotComesToRestExactlyAndStaysThere) {
  Plant plant = one_robot(sample_robot(), options());
  plant.write(0, duty_drive({-0.2, -0.15, 0.15, 0.2}));
  plant.advance(1'000'000'000);
  ASSERT_GT(std::abs(plant.truth(0).v_forward_m_s), 0.5);
  plant.write(0, duty_drive({0.0, 0.0, 0.0, 0.0}));
  plant.advance(3'000'000'000);
  const RobotTruth rest = plant.truth(0);
  EXPECT_EQ(rest.v_forward_m_s, 0.0);
  EXPECT_EQ(rest.v_left_m_s, 0.0);
  EXPECT_EQ(rest.omega_body_rad_s, 0.0);
  plant.advance(1'000'000'000);
  EXPECT_EQ(plant.truth(0).x_m, rest.x_m);
  EXPECT_EQ(plant.truth(0).y_m, rest.y_m);
  EXPECT_EQ(plant.truth(0).yaw_rad, rest.yaw_rad);
}

INSTANTIATE_TEST_SUITE_P(Joint, Friction, testing::Values(Physics::kPlanar, Physics::kSimbody),
                         [](const auto& test) {
                           return test.param == Physics::kPlanar ? "Planar" : "Simbody";
                         });

// One wheel in the air, its own scalar mechanics.
struct Bench {
  WheelDriveLaw law;
  DcDriveState winding{};
  double omega_wheel_rad_s = 0.0;

  explicit Bench(const RobotModel& m) : law(wheel_drive_law(m, 50e-6, 20)) {}

  WheelStep step(const BridgeInput& bridge) {
    const double before = omega_wheel_rad_s;
    WheelStep s = begin_wheel_step(law, winding, bridge, law.gear_ratio * before, 0.0);
    double after = before;
    if (!s.torque.locked) {
      const double rotor_Nm = s.torque.at(StepPart::kHeld, law.gear_ratio * before) -
                              law.viscous_Nm_s_per_rad * law.gear_ratio * before;
      after += law.gear_ratio * rotor_Nm / law.spin_inertia_kg_m2 * law.step_s;
    }
    omega_wheel_rad_s = end_wheel_step(law, winding, s, before, after);
    return s;
  }
};

TEST(WheelFriction, ACoastingWheelSlowsByCoulombOverInertiaAndStopsExactly) {
  RobotModel m = sample_robot();
  m.motor.viscous_friction_Nm_s_per_rad = 0.0;
  Bench bench(m);
  bench.omega_wheel_rad_s = 50.0;
  const double slowing_rad_s2 =
      m.gear_ratio * m.motor.coulomb_friction_Nm / bench.law.spin_inertia_kg_m2;  // gear tau_c / J
  const BridgeInput off{OMNIHIL_DRIVE_COAST, 0.0, m.bus_voltage_V};
  for (int ms = 1; ms * 1e-3 * slowing_rad_s2 < 50.0; ++ms) {
    bench.step(off);
    ASSERT_NEAR(bench.omega_wheel_rad_s, 50.0 - slowing_rad_s2 * ms * 1e-3, 1e-9);
  }
  bench.step(off);
  EXPECT_EQ(bench.omega_wheel_rad_s, 0.0);
  EXPECT_TRUE(bench.step(off).torque.locked);
}

TEST(WheelFriction, NeverAddsEnergyToACoastingWheel) {
  Bench bench(sample_robot());
  const BridgeInput off{OMNIHIL_DRIVE_COAST, 0.0, 24.0};
  for (double start : {-300.0, -1.0, -1e-6, 1e-9, 0.3, 80.0}) {
    bench.omega_wheel_rad_s = start;
    for (int ms = 0; ms < 5000; ++ms) {
      const double before = std::abs(bench.omega_wheel_rad_s);
      bench.step(off);
      ASSERT_LE(std::abs(bench.omega_wheel_rad_s), before);
      ASSERT_GE(bench.omega_wheel_rad_s * start, 0.0) << "friction turned the wheel round";
    }
    EXPECT_EQ(bench.omega_wheel_rad_s, 0.0);
  }
}

TEST(WheelFriction, ACrossingWheelKeepsAtMostTheSpeedThatFrictionAgainstItLeaves) {
  const RobotModel m = sample_robot();
  const WheelDriveLaw law = wheel_drive_law(m, 50e-6, 20);
  for (double before : {0.01, 0.5, 3.0}) {
    for (double after : {-1e-6, -0.02, -1.0, -20.0}) {
      WheelStep step;
      step.direction = 1.0;
      DcDriveState winding;
      const double settled = end_wheel_step(law, winding, step, before, after);
      // net torque before zero: |motor| + tau_c; past zero: |motor| - tau_c, over the same part of the step
      const double net_Nm = (before - after) / law.step_s * law.spin_inertia_kg_m2 / law.gear_ratio;
      const double past_Nm = net_Nm - 2.0 * m.motor.coulomb_friction_Nm;
      EXPECT_NEAR(settled, past_Nm > 0.0 ? after * past_Nm / net_Nm : 0.0, 1e-12);
    }
  }
}

TEST(WheelFriction, WithoutCoulombFrictionACrossingIsLeftAlone) {
  const WheelDriveLaw law = wheel_drive_law(frictionless_motor(sample_robot()), 50e-6, 20);
  WheelStep step;
  step.direction = 1.0;
  DcDriveState winding;
  EXPECT_EQ(end_wheel_step(law, winding, step, 0.5, -0.5), -0.5);
}

}  // namespace
}  // namespace omnihil
