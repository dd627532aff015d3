// The models in models/: complete, sourced, and the motors' constants agree with their data sheets.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hil/loop/model_store.h"
#include "sim/drive/dc_drive.h"
#include "sim/robot/validate.h"

namespace omnihil {
namespace {

const std::vector<std::string> kFolders = {OMNIHIL_SOURCE_DIR "/models"};
constexpr double kRpm = 2.0 * std::numbers::pi / 60.0;

ModelFile shipped(const std::string& name) {
  const StoredModel stored = load_model(name, kFolders);
  for (const ModelProblem& p : stored.problems) ADD_FAILURE() << p.text();
  return stored.model.value_or(ModelFile{});
}

std::vector<std::string> names(const char* folder) {
  std::vector<std::string> all;
  for (const ModelListing& m : list_models(kFolders)) {
    if (m.path.find(folder) != std::string::npos) all.push_back(m.name);
  }
  return all;
}

class Motor : public ::testing::TestWithParam<std::string> {};

TEST_P(Motor, EveryMotorNumberHasToleranceAndSource) {
  const ModelFile model = shipped(GetParam());
  for (const Parameter& p : model.parameters.parameters) {
    const bool physical = p.row->section == "motor" || p.row->section == "effects.coulomb_friction";
    if (!physical || p.origin == Origin::kDefault || p.row->kind != ParameterKind::kNumber) continue;
    EXPECT_TRUE(p.tolerance.has_value()) << parameter_path(*p.row);
    EXPECT_FALSE(p.source.empty()) << parameter_path(*p.row);
  }
}

// Speed and current at which the winding's torque is just the friction.
TEST_P(Motor, NoLoadSpeedAndCurrentAreThoseOfTheSheet) {
  const ModelFile model = shipped(GetParam());
  const auto* speed = model.parameters.find("datasheet.no_load_speed_rpm");
  if (speed == nullptr) GTEST_SKIP() << "the sheet figure is not public";
  const MotorParams& m = model.motor;
  const double k = m.torque_constant_Nm_per_A, r = m.resistance_ohm;
  const double u = model.parameters.find("datasheet.nominal_voltage_V")->value();
  // (k/R)(u - k omega) = c + b omega
  const double omega = (k / r * u - m.coulomb_friction_Nm) / (k * k / r + m.viscous_friction_Nm_s_per_rad);
  EXPECT_NEAR(omega / kRpm, speed->value(), *speed->tolerance * speed->value());
  if (const auto* current = model.parameters.find("datasheet.no_load_current_A")) {
    EXPECT_NEAR((u - k * omega) / r, current->value(), *current->tolerance * current->value());
  }
}

// Not by the formula but by the drive itself, run until it has settled.
TEST_P(Motor, TheDriveSettlesAtTheNoLoadSpeedOfItsConstants) {
  const MotorParams m = shipped(GetParam()).motor;
  const DcDrive drive = make_dc_drive(m, 0.0, 50e-6);
  DcDriveState state;
  double omega = 0.0;
  for (int ms = 0; ms < 1500; ++ms) {
    const double friction_Nm = m.coulomb_friction_Nm + m.viscous_friction_Nm_s_per_rad * omega;
    omega = advance_drive(drive, state,
                          {.mode = OMNIHIL_DRIVE_DUTY,
                           .duty_ratio = 1.0,
                           .bus_voltage_V = 12.0,
                           .omega_rotor_rad_s = omega,
                           .tau_load_Nm = friction_Nm},
                          20)
                .omega_end_rad_s;
  }
  const double k = m.torque_constant_Nm_per_A, r = m.resistance_ohm;
  const double expected =
      (k / r * 12.0 - m.coulomb_friction_Nm) / (k * k / r + m.viscous_friction_Nm_s_per_rad);
  EXPECT_NEAR(omega, expected, 1e-6 * expected);
}

TEST_P(Motor, StallTorqueAndSpeedConstantAreThoseOfTheSheet) {
  const ModelFile model = shipped(GetParam());
  const MotorParams& m = model.motor;
  const double u = model.parameters.find("datasheet.nominal_voltage_V")->value();
  int checked = 0;
  if (const auto* stall = model.parameters.find("datasheet.stall_torque_Nm")) {
    EXPECT_NEAR(m.torque_constant_Nm_per_A * u / m.resistance_ohm, stall->value(),
                *stall->tolerance * stall->value());
    ++checked;
  }
  if (const auto* constant = model.parameters.find("datasheet.speed_constant_rpm_per_V")) {
    EXPECT_NEAR(1.0 / m.torque_constant_Nm_per_A / kRpm, constant->value(), 0.01 * constant->value());
    ++checked;
  }
  if (checked == 0) GTEST_SKIP() << "the sheet figures are not public";
}

INSTANTIATE_TEST_SUITE_P(Shipped, Motor, ::testing::ValuesIn(names("/motors/")),
                         [](const auto& test) { return test.param; });

class Robot : public ::testing::TestWithParam<std::string> {};

TEST_P(Robot, EveryUncertainNumberHasASource) {
  const ModelFile model = shipped(GetParam());
  for (const Parameter& p : model.parameters.parameters) {
    if (!p.tolerance) continue;
    EXPECT_FALSE(p.source.empty()) << parameter_path(*p.row);
  }
  EXPECT_FALSE(model.name.empty());
  EXPECT_FALSE(model.source.empty());
  EXPECT_FALSE(model.radio.empty());
}

TEST_P(Robot, YawInertiaLiesBetweenAPointAndARing) {
  const RobotModel r = *shipped(GetParam()).robot;
  constexpr double kLargestRadius_m = 0.09;  // rules of the league
  EXPECT_GT(r.yaw_inertia_kg_m2, 0.25 * r.mass_kg * kLargestRadius_m * kLargestRadius_m);
  EXPECT_LT(r.yaw_inertia_kg_m2, r.mass_kg * kLargestRadius_m * kLargestRadius_m);
}

TEST_P(Robot, WheelInertiaIsThatOfADiscOfItsMassWithinAFactorOfTwo) {
  const RobotModel r = *shipped(GetParam()).robot;
  const double disc_kg_m2 = 0.5 * r.wheel_mass_kg * r.wheel_radius_m * r.wheel_radius_m;
  EXPECT_GT(r.wheel_inertia_kg_m2, 0.5 * disc_kg_m2);
  EXPECT_LT(r.wheel_inertia_kg_m2, 2.0 * disc_kg_m2);
}

// Nothing to complain of in a plant of one such robot, and room left to the stiffest sliding mode's limit.
TEST_P(Robot, StandsAndStepsAtOneMillisecond) {
  const RobotModel r = *shipped(GetParam()).robot;
  for (const Integrator integrator : {Integrator::kRungeKutta4, Integrator::kSemiImplicitEuler}) {
    PlantOptions options;
    options.integrator = integrator;
    for (const std::string& problem : plant_problems({&r, 1}, options)) ADD_FAILURE() << problem;
    EXPECT_LT(stiffest_contact_rate(r) * 1e-3, 0.9 * explicit_limit(integrator));
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Robot, ::testing::ValuesIn(names("/robots/")),
                         [](const auto& test) { return test.param; });

TEST(ShippedRobots, RoboTeamWheelAnglesGiveTheTeamsOwnRows) {
  const RobotModel r = *shipped("roboteam_2024").robot;
  const double f = 30.0 * std::numbers::pi / 180.0, b = 45.0 * std::numbers::pi / 180.0;
  const double rows[4][2] = {{std::cos(f), std::sin(f)},
                             {-std::cos(f), std::sin(f)},
                             {-std::cos(b), -std::sin(b)},
                             {std::cos(b), -std::sin(b)}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(-std::sin(r.wheel_angle_rad[i]), rows[i][0], 1e-12) << i;
    EXPECT_NEAR(std::cos(r.wheel_angle_rad[i]), rows[i][1], 1e-12) << i;
  }
}

TEST(ShippedRobots, UlavalCountsPerWheelTurnAreThoseOfItsFirmware) {
  const RobotModel r = *shipped("ulaval_delta").robot;
  EXPECT_EQ(r.encoder.counts_per_turn * r.gear_ratio, 5 * 4096);
}

}  // namespace
}  // namespace omnihil
