// Robots drawn about their model.
#include "sim/model/model_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

namespace omnihil {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

ModelFile default_model() {
  const std::string folder = OMNIHIL_SOURCE_DIR "/models/robots/";
  const ModelReading reading =
      read_model(text_of(folder + "omni_default.toml"), "omni_default.toml", [&](const std::string& motor) {
        return MotorFileText{motor, text_of(folder + motor), ""};
      });
  return *reading.model;
}

TEST(ModelSpread, NumbersHaveTheirTolerance) {
  const ModelFile model = default_model();
  const double mass_kg = model.robot->mass_kg, tolerance = *model.parameters.find("robot.mass_kg")->tolerance;
  constexpr int kRobots = 2000;
  double sum = 0.0, squares = 0.0;
  for (int robot = 0; robot < kRobots; ++robot) {
    const double x = spread_robot(model, 1.0, 7, robot, {}).mass_kg / mass_kg - 1.0;
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kRobots, 0.0, 4.0 * tolerance / std::sqrt(kRobots));
  EXPECT_NEAR(std::sqrt(squares / kRobots), tolerance, 4.0 * tolerance / std::sqrt(2.0 * kRobots));
}

TEST(ModelSpread, SameSeedSameRobotOthersOthers) {
  const ModelFile model = default_model();
  const RobotModel a = spread_robot(model, 1.0, 7, 3, {});
  EXPECT_EQ(a.mass_kg, spread_robot(model, 1.0, 7, 3, {}).mass_kg);
  EXPECT_NE(a.mass_kg, spread_robot(model, 1.0, 7, 4, {}).mass_kg);
  EXPECT_NE(a.mass_kg, spread_robot(model, 1.0, 8, 3, {}).mass_kg);
  EXPECT_NE(a.mass_kg / model.robot->mass_kg, a.yaw_inertia_kg_m2 / model.robot->yaw_inertia_kg_m2);
  EXPECT_EQ(spread_robot(model, 0.0, 7, 3, {}).mass_kg, model.robot->mass_kg);
}

TEST(ModelSpread, WhatIsKnownExactlyStaysAndFirmwareIsToldTheModel) {
  const ModelFile model = default_model();
  const RobotModel a = spread_robot(model, 2.0, 7, 3, {});
  EXPECT_EQ(a.gear_ratio, model.robot->gear_ratio);
  EXPECT_EQ(a.wheel_angle_rad, model.robot->wheel_angle_rad);
  ASSERT_NE(a.told, nullptr);
  EXPECT_EQ(a.told->motor.resistance_ohm, model.robot->motor.resistance_ohm);
  EXPECT_NE(a.motor.resistance_ohm, model.robot->motor.resistance_ohm);
}

TEST(ModelSpread, EveryDrawCanRun) {
  const ModelFile model = default_model();
  PlantOptions options;
  options.physics = Physics::kPlanar;
  std::vector<RobotModel> robots;
  for (int robot = 0; robot < 50; ++robot) robots.push_back(spread_robot(model, 3.0, 11, robot, options));
  EXPECT_NO_THROW(Plant(robots, options));
}

}  // namespace
}  // namespace omnihil
