// The omni wheel with its rollers: energy, momentum, rolling, and that steps converge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/full_wheel/full_wheel_robot.h"
#include "sim/full_wheel/wheel_comparison.h"
#include "sim/robot/geometry.h"
#include "sim/robot/planar_law.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

RobotModel centred() {
  RobotModel model = sample_robot();
  model.center_of_mass_x_m = model.center_of_mass_y_m = 0.0;
  return model;
}

TyreCurve none() { return {0.1, 0.0, 0.4, 0.0}; }

// |kinetic - (work in - work lost)| over work in, after the curve that has everything in it.
double energy_error(double step_s) {
  const RobotModel model = sample_robot();
  const WheelManoeuvre curve = wheel_manoeuvres(model)[4];
  FullWheelRobot robot(model, {});
  for (double t = 0.0; t < 1.0; t += step_s) {
    robot.set_volts(curve.volt(t));
    robot.advance(step_s);
  }
  return std::abs(robot.kinetic_J() - (robot.work_in_J() - robot.work_lost_J())) / robot.work_in_J();
}

TEST(FullWheel, EnergyIsTheWorkPutInLessTheWorkLost) {
  const double coarse = energy_error(2e-4), fine = energy_error(5e-5);
  EXPECT_LT(fine, 0.01);
  EXPECT_LT(fine, 0.6 * coarse);  // semi-implicit Euler: of first order in the step
}

TEST(FullWheel, NothingIsCreatedWithoutMotors) {
  FullWheelRobot robot(centred(), {});
  robot.set_torques({});
  robot.set_velocity(1.0, 0.7, 3.0);
  double last_J = robot.kinetic_J();
  for (int n = 0; n < 5000; ++n) {
    robot.advance(1e-4);
    const double now_J = robot.kinetic_J();
    ASSERT_LE(now_J, last_J * (1.0 + 1e-4)) << "at step " << n;
    last_J = now_J;
  }
  EXPECT_NEAR(robot.work_in_J(), 0.0, 1e-12);
  EXPECT_GT(robot.work_lost_J(), 0.0);
}

TEST(FullWheel, WithoutGripAPushIsMassTimesAcceleration) {
  RobotModel model = centred();
  model.tyre_longitudinal = model.tyre_lateral = none();
  FullWheelRobot robot(model, {});
  robot.set_torques({});
  robot.push(3.0, -1.0);
  for (int n = 0; n < 1000; ++n) robot.advance(1e-4);
  EXPECT_NEAR(robot.state().v_x_m_s, 3.0 * 0.1 / model.mass_kg, 1e-9);
  EXPECT_NEAR(robot.state().v_y_m_s, -1.0 * 0.1 / model.mass_kg, 1e-9);
  EXPECT_NEAR(robot.state().omega_rad_s, 0.0, 1e-9);
}

// Torque on a wheel off the ground of all four: the inertia that turns is the model's, rollers included.
TEST(FullWheel, WithoutGripAWheelTurnsByTheModelsInertia) {
  RobotModel model = centred();
  model.tyre_longitudinal = model.tyre_lateral = none();
  FullWheelRobot robot(model, {});
  robot.set_torques({1e-3, 1e-3, 1e-3, 1e-3});
  for (int n = 0; n < 1000; ++n) robot.advance(1e-4);
  for (const double w : robot.wheel_rad_s()) EXPECT_NEAR(w * spin_inertia_kg_m2(model), 1e-3 * 0.1, 1e-9);
}

// Coasting with the wheels' rims at the floor's speed, the loaded roller turns by the speed along the axle over its radius
// there, between r in the middle and r (cos) at the hand-over.
TEST(FullWheel, RollersRollByTheSpeedAlongTheAxle) {
  RobotModel model = centred();
  model.tyre_lateral = none();  // bearings without friction
  const RollerParams rollers;
  FullWheelRobot robot(model, rollers);
  robot.set_torques({});
  robot.set_velocity(0.8, 0.5, 0.0);
  for (int n = 0; n < 3000; ++n) robot.advance(1e-4);
  const WheelGeometry<double> geometry = wheel_geometry(model);
  const PlanarState s = robot.state();
  const double pitch = 2.0 * 3.14159265358979323846 / rollers.count;
  const double thin_m =
      model.wheel_radius_m * std::cos(0.5 * pitch) - (model.wheel_radius_m - rollers.radius_m);
  const double c = std::cos(s.yaw_rad), n = std::sin(s.yaw_rad);
  const BodyVelocity<double> v{c * s.v_x_m_s + n * s.v_y_m_s, -n * s.v_x_m_s + c * s.v_y_m_s, s.omega_rad_s};
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double along_axle_m_s = std::abs(roller_speed_m_s(geometry, i, v));
    EXPECT_GE(std::abs(robot.roller_rad_s(i)), 0.98 * along_axle_m_s / rollers.radius_m) << "wheel " << i + 1;
    EXPECT_LE(std::abs(robot.roller_rad_s(i)), 1.02 * along_axle_m_s / thin_m) << "wheel " << i + 1;
    EXPECT_NEAR(rim_speed_m_s(geometry, i, v), model.wheel_radius_m * robot.wheel_rad_s()[i], 0.03);
  }
}

// What the simplified wheel calls its lateral curve is the bearings' friction: a wheel pushed sideways feels c N.
TEST(FullWheel, SidewaysAWheelFeelsItsBearings) {
  RobotModel model = centred();
  model.tyre_lateral = {1.0, 0.05, 2.0, 0.05};
  FullWheelRobot robot(model, {});
  robot.set_torques({});
  robot.set_velocity(1.0, 0.0, 0.0);
  for (int n = 0; n < 500; ++n) robot.advance(1e-4);
  double sum_N = 0.0;
  for (const double f : robot.force_across_N()) {
    sum_N += std::abs(f);
    EXPECT_NEAR(std::abs(f) / (0.25 * model.mass_kg * 9.81), 0.05, 0.02);  // loads differ, barrels' radii too
  }
  EXPECT_NEAR(sum_N, 0.05 * model.mass_kg * 9.81, 0.1 * 0.05 * model.mass_kg * 9.81);
}

TEST(FullWheel, HalfTheStepIsHalfTheError) {
  const RobotModel model = sample_robot();
  const WheelManoeuvre curve{"curve", 1.0, wheel_manoeuvres(model)[4].volt};
  const WheelRun best = run_full_wheel(model, {}, curve, 2.5e-5);
  const double coarse_m = difference_of(best, run_full_wheel(model, {}, curve, 2e-4)).rms_m;
  const double fine_m = difference_of(best, run_full_wheel(model, {}, curve, 1e-4)).rms_m;
  EXPECT_LT(fine_m, 0.7 * coarse_m);
  EXPECT_LT(fine_m, 1e-3);
}

TEST(FullWheel, ManyRollersStillAreOneWheel) {
  const RobotModel model = sample_robot();
  const WheelManoeuvre turn{"turn", 0.5, wheel_manoeuvres(model)[3].volt};
  RollerParams many;
  many.count = 36;
  many.mass_kg = 0.001;
  const WheelDifference d =
      difference_of(run_full_wheel(model, {}, turn, 1e-4), run_full_wheel(model, many, turn, 1e-4));
  EXPECT_LT(std::abs(d.end_rad), 0.02 * d.turned_rad);
}

TEST(FullWheel, RollersHeavierThanTheWheelAreRefused) {
  RollerParams heavy;
  heavy.mass_kg = 0.05;
  EXPECT_THROW(FullWheelRobot(sample_robot(), heavy), std::invalid_argument);
}

// The paper's claim, on the model that ships: two tyre curves come close to 72 rollers where nothing skids.
TEST(WheelComparison, TheSimplifiedWheelStaysCloseWhereNothingSkids) {
  const RobotModel model = sample_robot();
  for (const WheelManoeuvre& m : wheel_manoeuvres(model)) {
    if (m.name == "hard start") continue;
    const WheelRun full = run_full_wheel(model, {}, m, 1e-4);
    const WheelDifference planar = difference_of(full, run_simplified(model, m, Physics::kPlanar, 5e-4));
    const WheelDifference simbody = difference_of(full, run_simplified(model, m, Physics::kSimbody, 5e-4));
    EXPECT_LT(planar.end_m, 0.05 * std::max(0.2, planar.way_m)) << m.name;
    EXPECT_NEAR(planar.end_m, simbody.end_m, 1e-4) << m.name;
  }
}

TEST(WheelComparison, EqualRunsDoNotDiffer) {
  WheelRun run;
  run.at = {{0, 0, 0, 1, 0, 0}, {0.01, 0, 0.1, 1, 0, 0}};
  const WheelDifference d = difference_of(run, run);
  EXPECT_EQ(d.rms_m, 0.0);
  EXPECT_EQ(d.end_m, 0.0);
  EXPECT_NEAR(d.way_m, 0.01, 1e-12);
  EXPECT_NEAR(d.turned_rad, 0.1, 1e-12);
}

}  // namespace
}  // namespace omnihil
