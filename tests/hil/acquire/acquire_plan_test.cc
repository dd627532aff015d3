// Plans: read, written, and what they ask of the floor.
#include "hil/acquire/acquire_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hil/acquire/floor_need.h"

namespace omnihil {
namespace {

constexpr const char* kPlan = R"(
format = "omnihil-plan/1"
title = "what \"the\" carpet does"
drive = "body_velocity"
packets_Hz = 50
[limits]
area_m = [-1, -2, 1, 2]
battery_V = 21
[[run]]
name = "fit_1"
use = "fit"
duration_s = 2.0
steps = [[0.0, 1.0, 0.0, 0.0], [0.5, -1.0, 0.25, 2.0]]
[[run]]
name = "h"
use = "holdout"
duration_s = 1.0
steps = [[0, 0, 0, 0]]
)";

TEST(AcquirePlan, WhatIsWrittenIsReadBack) {
  const PlanReading read = read_acquire_plan(kPlan, "plan.toml");
  for (const ModelProblem& p : read.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(read.plan);
  const AcquirePlan& plan = *read.plan;
  EXPECT_EQ(plan.title, "what \"the\" carpet does");
  EXPECT_EQ(plan.packets_Hz, 50.0);
  ASSERT_EQ(plan.runs.size(), 2u);
  EXPECT_EQ(plan.runs[1].use, Split::kValidation);
  EXPECT_EQ((*plan.limits.area_m)[3], 2.0);
  EXPECT_EQ(plan_value(plan.runs[0], 0.49)[0], 1.0);
  EXPECT_EQ(plan_value(plan.runs[0], 0.5)[0], -1.0);
  EXPECT_EQ(plan_value(plan.runs[0], 1.999)[2], 2.0);
  EXPECT_EQ(plan_value(plan.runs[0], 2.0)[0], 0.0);
  EXPECT_EQ(plan_value(plan.runs[0], -0.1)[0], 0.0);
  const std::string text = plan_text(plan);
  const PlanReading again = read_acquire_plan(text, "again.toml");
  for (const ModelProblem& p : again.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(again.plan);
  EXPECT_EQ(plan_text(*again.plan), text);
}

TEST(AcquirePlan, EveryFaultIsNamedWithItsLine) {
  const PlanReading read = read_acquire_plan(R"(format = "omnihil-plan/1"
drive = "body"
packets_Hz = 0
[limits]
area_m = [1, 0, 0, 1]
speed = 3
[[run]]
name = "a b"
use = "fit"
duration_s = 1
steps = [[0.1, 1, 0, 0]]
[[run]]
name = "c"
use = "test"
duration_s = 1
steps = [[0, 1, 0, 0], [0, 2, 0, 0]]
)",
                                             "p.toml");
  EXPECT_FALSE(read.plan);
  std::string all;
  for (const ModelProblem& p : read.problems) all += p.text() + "\n";
  for (const char* line :
       {"p.toml:2", "p.toml:3", "p.toml:5", "p.toml:6", "p.toml:7", "p.toml:11", "p.toml:14", "p.toml:16"})
    EXPECT_NE(all.find(line), std::string::npos) << line << "\n" << all;
}

RollingParams<double> robot() {
  RollingParams<double> p;
  const double d = std::numbers::pi / 180.0;
  p.wheel_angle_rad = {55 * d, 135 * d, 225 * d, 305 * d};
  p.wheel_radius_m = 0.027;
  p.wheel_center_radius_m = 0.08;
  p.drive.supply_voltage_V = 24.0;
  p.drive.torque_constant_Nm_per_A = 0.03;
  p.drive.gear_ratio = 3.0;
  return p;
}

AcquirePlan one_run(PlanDrive drive, double duration_s, std::vector<PlanStep> steps) {
  AcquirePlan plan;
  plan.drive = drive;
  plan.runs = {{"r", Split::kTraining, "", duration_s, std::move(steps)}};
  return plan;
}

TEST(FloorNeed, AStraightDriveIsItsLength) {
  const AcquirePlan plan = one_run(PlanDrive::kBodyVelocity, 2.0, {{0.0, {1.5, 0, 0}}, {1.0, {-0.5, 0, 0}}});
  const FloorNeed n = floor_need(plan, plan.runs[0], robot());
  EXPECT_NEAR(n.x_to_m, 1.5, 1e-9);
  EXPECT_NEAR(n.x_from_m, 0.0, 1e-9);
  EXPECT_NEAR(n.x_end_m, 1.0, 1e-9);
  EXPECT_NEAR(n.fastest_m_s, 1.5, 1e-12);
  EXPECT_NEAR(n.stopping_m, 1.5 * 1.5 / 4.0, 1e-12);  // v^2 / (2 * 2 m/s2)
}

TEST(FloorNeed, ACircleIsAsWideAsItsDiameter) {
  // 1 m/s ahead and 2 rad/s: a radius of 0.5 m to the left; once round in pi seconds.
  const AcquirePlan plan = one_run(PlanDrive::kBodyVelocity, std::numbers::pi, {{0.0, {1.0, 0, 2.0}}});
  const FloorNeed n = floor_need(plan, plan.runs[0], robot());
  EXPECT_NEAR(n.y_to_m, 1.0, 2e-3);  // within what one step of 1 ms covers
  EXPECT_NEAR(n.x_to_m, 0.5, 2e-3);
  EXPECT_NEAR(n.x_from_m, -0.5, 2e-3);
  EXPECT_NEAR(n.farthest_m, 1.0, 2e-3);
  EXPECT_NEAR(std::hypot(n.x_end_m, n.y_end_m), 0.0, 2e-3);
}

TEST(FloorNeed, WheelsAllAlikeTurnOnTheSpot) {
  for (const PlanDrive drive : {PlanDrive::kWheelSpeed, PlanDrive::kWheelDuty}) {
    const AcquirePlan plan = one_run(drive, 1.0, {{0.0, {0.2, 0.2, 0.2, 0.2}}});
    EXPECT_NEAR(floor_need(plan, plan.runs[0], robot()).farthest_m, 0.0, 1e-9);
  }
  // omega = duty V / k / gear = 0.2 * 24 / 0.03 / 3; w = omega R / R_b
  const auto body = asked_of_body(PlanDrive::kWheelDuty, {0.2, 0.2, 0.2, 0.2}, robot());
  EXPECT_NEAR(body[2], 0.2 * 24.0 / 0.03 / 3.0 * 0.027 / 0.08, 1e-9);
}

}  // namespace
}  // namespace omnihil
