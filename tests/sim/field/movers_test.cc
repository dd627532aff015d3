// Movers and tipping: held bodies that go their way, robots that fall.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/field/world.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

constexpr double kR = 0.0215;

World make_world(const RobotModel& model, Physics physics = Physics::kPlanar) {
  PlantOptions plant;
  plant.physics = physics;
  return World(std::vector{model}, plant, WorldOptions{});
}

Mover mover_at(double x_m, double y_m, double v_x_m_s) {
  Mover m;
  m.state.x_m = x_m;
  m.state.y_m = y_m;
  m.state.v_x_m_s = v_x_m_s;
  return m;
}

TEST(Movers, GoTheirWayByTheirSpeeds) {
  World world = make_world(sample_robot());
  Mover m = mover_at(1.0, 1.0, -0.5);
  m.state.omega_rad_s = 2.0;
  world.set_movers(std::vector{m});
  world.put_robot(0, 0.95, 1.0, 0.0);  // in its way: it is pushed, the mover is not
  world.advance(1'000'000'000);
  ASSERT_EQ(world.movers().size(), 1u);
  EXPECT_NEAR(world.movers()[0].state.x_m, 0.5, 1e-9);
  EXPECT_NEAR(world.movers()[0].state.yaw_rad, 2.0, 1e-9);
}

TEST(Movers, PushARobotThatStandsInTheirWay) {
  World world = make_world(sample_robot());
  world.put_robot(0, 0.0, 0.0, 0.0);
  world.set_movers(std::vector{mover_at(-0.5, 0.0, 1.0)});
  bool touched = false;
  for (int ms = 0; ms < 1000; ++ms) {
    world.advance(1'000'000);
    for (const WorldEvent& e : world.events())
      touched = touched || (e.kind == WorldEventKind::kRobotsTouch && e.robot == 0 && e.other == -1);
  }
  EXPECT_TRUE(touched);
  // The mover is at 0.5 m now, and the robot's round side is before it.
  const double gap_m = world.plant().planar_state(0).x_m - world.movers()[0].state.x_m;
  EXPECT_GT(gap_m, 0.0725 + 0.08);
  EXPECT_NEAR(world.movers()[0].state.x_m, 0.5, 1e-9);
}

// Against a wall that moves at u a ball of speed v leaves with u + e (u - v).
TEST(Movers, ABallBouncesOffByTheirSpeed) {
  World world = make_world(sample_robot());
  world.put_robot(0, 5.0, 5.0, 0.0);
  Mover m = mover_at(0.0, 0.0, -1.0);
  m.state.yaw_rad = M_PI;  // its flat front first
  world.set_movers(std::vector{m});
  const double e = BallHandling{}.restitution;
  world.put_ball(-0.0725 - kR - 0.01, 0.0, 0.0, {0, 0, 0});
  double most_m_s = 0.0;
  for (int step = 0; step < 40; ++step) {
    world.advance(500'000);
    most_m_s = std::min(most_m_s, world.ball()->velocity.x());
  }
  EXPECT_NEAR(most_m_s, -(1.0 + e), 0.01);
}

TEST(Movers, AreGoneWhenThereAreNone) {
  World world = make_world(sample_robot());
  world.set_movers(std::vector{mover_at(0.0, 0.0, 0.0)});
  world.set_movers({});
  world.put_robot(0, 0.0, 0.0, 0.0);
  world.advance(10'000'000);
  EXPECT_EQ(world.plant().planar_state(0).x_m, 0.0);
}

// A tower: its centre of mass twice as high as its wheels are apart.
RobotModel tower() {
  RobotModel model = sample_robot();
  model.center_of_mass_height_m = 0.25;
  model.tyre_longitudinal.extremum_value = 1.5;
  model.tyre_longitudinal.asymptote_value = 1.4;
  return model;
}

int tips_of(World& world, double duty) {
  const RobotModel m = sample_robot();
  RobotDrive d{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    d.mode[i] = OMNIHIL_DRIVE_DUTY;
    d.duty_ratio[i] = -duty * std::sin(m.wheel_angle_rad[i]);
  }
  world.write(0, d);
  int tips = 0;
  for (int ms = 0; ms < 1500; ++ms) {
    world.advance(1'000'000);
    for (const WorldEvent& e : world.events()) tips += e.kind == WorldEventKind::kTip;
  }
  return tips;
}

TEST(Tipping, ATowerThatAcceleratesFallsOnceAndAUsualRobotDoesNot) {
  World falls = make_world(tower(), Physics::kSimbodyFree),
        stands = make_world(sample_robot(), Physics::kSimbodyFree);
  EXPECT_EQ(tips_of(stands, 1.0), 0);
  EXPECT_EQ(tips_of(falls, 1.0), 1);
  EXPECT_GT(falls.plant().tilt_rad(0), std::atan(0.08 / 0.25));
}

}  // namespace
}  // namespace omnihil
