// Faults of a robot: each does what robot_faults.h says, on every kind of drive; none leaves a trace.
#include <gtest/gtest.h>

#include <numbers>

#include "sim/drive/thermal.h"
#include "sim/robot/electric_model.h"
#include "tests/sim/effects/robot_bench.h"

namespace omnihil {
namespace {

using test::drive_for;
using test::forward;
using test::robot_with;

enum class Kind { kPlain, kEffects, kShaft, kDq };

RobotModel robot_of(Kind kind) {
  RobotModel m = symmetric_robot();
  if (kind == Kind::kEffects) return robot_with(m, {"cogging"});
  if (kind == Kind::kShaft) return robot_with(m, {"backlash"});
  if (kind == Kind::kDq) {
    m.motor.pole_pairs = 8;
    ElectricModel e;
    e.kind = DriveKind::kDq;
    m.electric = std::make_shared<const ElectricModel>(e);
  }
  return m;
}

class PlantFaults : public testing::TestWithParam<Kind> {
 protected:
  RobotModel model_ = robot_of(GetParam());
  Plant plant_ = one_robot(model_, planar_options(500'000));
  double omega_wheel_rad_s(std::size_t wheel) const { return plant_.truth(0).omega_wheel_rad_s[wheel]; }
};

TEST_P(PlantFaults, BlockedWheelStandsAndItsMotorDrawsTheStallCurrent) {
  drive_for(plant_, forward(model_, 0.1), 0.3);
  ASSERT_GT(std::abs(omega_wheel_rad_s(1)), 5.0);
  RobotFaults faults;
  faults.blocked[1] = true;
  plant_.set_faults(0, faults);
  const double angle_rad = plant_.truth(0).theta_wheel_rad[1];
  plant_.advance(400'000'000);
  EXPECT_EQ(omega_wheel_rad_s(1), 0.0);
  EXPECT_NEAR(plant_.truth(0).theta_wheel_rad[1], angle_rad, 1e-12);
  const double duty = forward(model_, 0.1).duty_ratio[1];
  if (GetParam() == Kind::kPlain || GetParam() == Kind::kEffects) {
    // R i = duty U at standstill
    const double stall_A = duty * model_.bus_voltage_V / model_.motor.resistance_ohm;
    EXPECT_NEAR(plant_.truth(0).motor_current_A[1], stall_A, 0.01 * std::abs(stall_A));
  }
  plant_.set_faults(0, {});
  plant_.advance(300'000'000);
  EXPECT_GT(std::abs(omega_wheel_rad_s(1)), 5.0);
}

TEST_P(PlantFaults, LiftedWheelFeelsNoFloorAndRunsFree) {
  RobotFaults faults;
  faults.lifted = {true, true, true, true};
  plant_.set_faults(0, faults);
  drive_for(plant_, forward(model_, 0.1), 1.0);
  const RobotTruth t = plant_.truth(0);
  for (std::size_t i = 0; i < kWheels; ++i) {
    EXPECT_EQ(t.force_longitudinal_N[i], 0.0);
    EXPECT_EQ(t.load_N[i], 0.0);
    EXPECT_GT(std::abs(t.omega_wheel_rad_s[i]), 5.0);
  }
  EXPECT_EQ(t.x_m, 0.0);
}

TEST_P(PlantFaults, StuckEncoderKeepsItsCountsWhileTheWheelTurns) {
  drive_for(plant_, forward(model_, 0.1), 0.2);
  const RobotSensors before = plant_.sample_sensors(0);
  RobotFaults faults;
  faults.encoder_stuck[2] = true;
  plant_.set_faults(0, faults);
  plant_.advance(200'000'000);
  const RobotSensors stuck = plant_.sample_sensors(0);
  EXPECT_EQ(stuck.encoder_counts[2], before.encoder_counts[2]);
  EXPECT_NE(stuck.encoder_counts[1], before.encoder_counts[1]);
  EXPECT_GT(std::abs(omega_wheel_rad_s(2)), 5.0);
  plant_.set_faults(0, {});
  EXPECT_NE(plant_.sample_sensors(0).encoder_counts[2], before.encoder_counts[2]);
}

TEST_P(PlantFaults, SupplyDipReachesBridgesAndSensor) {
  RobotFaults faults;
  faults.lifted = {true, true, true, true};
  plant_.set_faults(0, faults);
  drive_for(plant_, forward(model_, 0.2), 1.5);
  const double full_rad_s = omega_wheel_rad_s(2);
  faults.supply_ratio = 0.5;
  plant_.set_faults(0, faults);
  plant_.advance(1'500'000'000);
  EXPECT_NEAR(plant_.sample_sensors(0).bus_voltage_V, 0.5 * model_.bus_voltage_V, 1e-9);
  // k omega = duty U less what friction takes: half the voltage, a little less than half the speed
  EXPECT_LT(std::abs(omega_wheel_rad_s(2)), 0.5 * std::abs(full_rad_s));
  EXPECT_GT(std::abs(omega_wheel_rad_s(2)), 0.4 * std::abs(full_rad_s));
}

TEST_P(PlantFaults, ForceSpeedsUpABodyInTheAirByNewton) {
  RobotFaults faults;
  faults.lifted = {true, true, true, true};
  faults.force_forward_N = 3.0;
  plant_.set_faults(0, faults);
  drive_for(plant_, duty_drive({}), 0.5);
  // v = F t / m
  EXPECT_NEAR(plant_.truth(0).v_forward_m_s, 3.0 * 0.5 / model_.mass_kg, 1e-9);
  EXPECT_NEAR(plant_.sample_sensors(0).accel_x_m_s2, 3.0 / model_.mass_kg, 1e-9);
}

TEST_P(PlantFaults, NeutralFaultsChangeNoBitAndStateGoesOnAfterRestore) {
  Plant other = one_robot(model_, planar_options(500'000));
  other.set_faults(0, {});
  excite(plant_, 0.3);
  excite(other, 0.3);
  EXPECT_EQ(plant_.save(), other.save());
  RobotFaults faults;
  faults.blocked[0] = faults.phase_lost[1] = faults.encoder_stuck[3] = true;
  faults.winding_rise_K[2] = 80.0;
  faults.supply_ratio = 0.7;
  plant_.set_faults(0, faults);
  excite(plant_, 0.1);
  ASSERT_TRUE(other.restore(plant_.save()));
  EXPECT_EQ(other.faults(0), faults);
  excite(plant_, 0.2);
  excite(other, 0.2);
  EXPECT_EQ(plant_.save(), other.save());
}

INSTANTIATE_TEST_SUITE_P(Drives, PlantFaults,
                         testing::Values(Kind::kPlain, Kind::kEffects, Kind::kShaft, Kind::kDq));

TEST(PlantFaultsOfDcDrive, LostPhaseGivesNoTorque) {
  for (const Kind kind : {Kind::kPlain, Kind::kEffects}) {
    const RobotModel m = robot_of(kind);
    Plant plant = one_robot(m, planar_options(500'000));
    RobotFaults faults;
    faults.phase_lost[0] = true;
    plant.set_faults(0, faults);
    drive_for(plant, duty_drive({0.3, 0.3, 0.3, 0.3}), 0.2);
    EXPECT_EQ(plant.truth(0).motor_current_A[0], 0.0);
    EXPECT_NE(plant.truth(0).motor_current_A[1], 0.0);
  }
}

TEST(PlantFaultsOfDqDrive, LostLegCostsTorqueButNotAll) {
  const RobotModel m = robot_of(Kind::kDq);
  Plant plant = one_robot(m, planar_options(500'000));
  RobotFaults faults;
  faults.lifted = {true, true, true, true};
  plant.set_faults(0, faults);
  drive_for(plant, duty_drive({0.2, 0.2, 0.2, 0.2}), 1.0);
  const double whole_rad_s = plant.truth(0).omega_wheel_rad_s[0];
  faults.phase_lost[0] = true;
  plant.set_faults(0, faults);
  plant.advance(1'000'000'000);
  EXPECT_LT(plant.truth(0).omega_wheel_rad_s[0], 0.99 * whole_rad_s);
  EXPECT_NEAR(plant.truth(0).omega_wheel_rad_s[1], whole_rad_s, 0.01 * whole_rad_s);
}

TEST(PlantFaultsOfDcDrive, HotWindingStallsWithLessCurrent) {
  for (const Kind kind : {Kind::kPlain, Kind::kEffects}) {
    const RobotModel m = robot_of(kind);
    Plant plant = one_robot(m, planar_options(500'000));
    RobotFaults faults;
    faults.blocked[0] = faults.blocked[1] = true;
    faults.winding_rise_K[0] = 100.0;
    plant.set_faults(0, faults);
    drive_for(plant, duty_drive({0.05, 0.05, 0.05, 0.05}), 0.3);
    const RobotTruth t = plant.truth(0);
    // i = U / (R (1 + alpha dT))
    const double expected = 1.0 / (1.0 + kCopperPerK * 100.0);
    EXPECT_NEAR(t.motor_current_A[0] / t.motor_current_A[1], expected, 1e-3);
  }
}

TEST(PlantFaultsOfPhysics, SimbodyAndClosedFormAgreeUnderFaults) {
  const RobotModel m = symmetric_robot();
  PlantOptions o = planar_options(500'000);
  Plant planar = one_robot(m, o);
  o.physics = Physics::kSimbody;
  Plant simbody = one_robot(m, o);
  RobotFaults faults;
  faults.lifted[1] = faults.blocked[2] = true;
  faults.force_left_N = 2.0;
  for (Plant* plant : {&planar, &simbody}) {
    plant->set_faults(0, faults);
    drive_for(*plant, forward(m, 0.15), 0.4);
  }
  EXPECT_NEAR(planar.truth(0).x_m, simbody.truth(0).x_m, 1e-9);
  EXPECT_NEAR(planar.truth(0).y_m, simbody.truth(0).y_m, 1e-9);
  EXPECT_NEAR(planar.truth(0).yaw_rad, simbody.truth(0).yaw_rad, 1e-9);
}

}  // namespace
}  // namespace omnihil
