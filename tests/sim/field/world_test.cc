// The world: what touches, kicks, is held and scored; a robot alone is as it was.
#include "sim/field/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "sim/field/dribbler.h"
#include "sim/robot/planar_law.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

constexpr double kR = 0.0215;

World make(int robots, const WorldOptions& options = {}, Physics physics = Physics::kPlanar) {
  PlantOptions plant;
  plant.physics = physics;
  return World(std::vector<RobotModel>(static_cast<std::size_t>(robots), sample_robot()), plant, options);
}

// Duties that drive it forward, by its wheels' angles.
RobotDrive forward(double duty) {
  const RobotModel m = sample_robot();
  RobotDrive d{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    d.mode[i] = OMNIHIL_DRIVE_DUTY;
    d.duty_ratio[i] = -duty * std::sin(m.wheel_angle_rad[i]);
  }
  return d;
}

TEST(World, ARobotAloneHasTheBitsOfAPlantAlone) {
  for (const Physics physics : {Physics::kPlanar, Physics::kSimbody}) {
    World world = make(1, {.field = &kFieldDivisionB}, physics);
    PlantOptions options;
    options.physics = physics;
    Plant plant(std::vector{sample_robot()}, options);
    world.put_ball(3.0, 2.0, kR, {0, 0, 0});
    for (int ms = 0; ms < 200; ++ms) {
      const RobotDrive d = forward(0.3 * std::sin(0.05 * ms));
      world.write(0, d);
      plant.write(0, d);
      world.advance(1'000'000);
      plant.advance(1'000'000);
    }
    EXPECT_EQ(world.plant().save(), plant.save());
  }
}

TEST(World, TwoRobotsThatMeetKeepTheirMomentumAndLoseEnergy) {
  World world = make(2);
  world.put_robot(0, 0.0, 0.0, 0.3);
  world.put_robot(1, 0.25, 0.05, 2.0);
  world.set_velocity(0, 1.5, 0.1, 0.0);
  world.set_velocity(1, -1.0, 0.0, 0.5);
  double energy_J = world.energy_J();
  bool touched = false;
  for (int ms = 0; ms < 100; ++ms) {
    world.advance(1'000'000);
    for (const WorldEvent& e : world.events()) touched = touched || e.kind == WorldEventKind::kRobotsTouch;
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(world.energy_J(), energy_J);
  const PlanarState a = world.plant().planar_state(0), b = world.plant().planar_state(1);
  EXPECT_GT(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), 0.15);
}

TEST(World, PlanarAndSimbodyAgreeThroughACollision) {
  World planar = make(2), simbody = make(2, {}, Physics::kSimbody);
  for (World* world : {&planar, &simbody}) {
    world->put_robot(0, 0.0, 0.0, 0.0);
    world->put_robot(1, 0.3, 0.06, 3.0);
    world->put_ball(0.15, 0.0, kR, {0.2, 0, 0});
    world->set_velocity(0, 1.0, 0.0, 0.0);
    for (int ms = 0; ms < 300; ++ms) {
      world->write(0, forward(0.2));
      world->advance(1'000'000);
    }
  }
  for (int n = 0; n < 2; ++n) {
    const PlanarState p = planar.plant().planar_state(n), s = simbody.plant().planar_state(n);
    EXPECT_NEAR(p.x_m, s.x_m, 1e-9);
    EXPECT_NEAR(p.y_m, s.y_m, 1e-9);
    EXPECT_NEAR(p.yaw_rad, s.yaw_rad, 1e-9);
  }
  EXPECT_NEAR((planar.ball()->position - simbody.ball()->position).norm(), 0.0, 1e-9);
}

TEST(World, ARobotDoesNotLeaveTheBoards) {
  World world = make(1, {.field = &kFieldSeedPaper});
  world.put_robot(0, 2.5, 0.0, 0.4);
  for (int ms = 0; ms < 4000; ++ms) {
    world.write(0, forward(0.5));
    world.advance(1'000'000);
    const PlanarState s = world.plant().planar_state(0);
    ASSERT_LT(s.x_m, kFieldSeedPaper.half_length_m() + 0.3 - 0.07);
    ASSERT_LT(std::abs(s.y_m), kFieldSeedPaper.half_width_m() + 0.3 - 0.07);
  }
}

TEST(World, AKickGivesTheBallItsSpeedAndTheRobotTheRecoil) {
  World world = make(1);
  world.put_ball(0.0725 + kR + 0.009, 0.0, kR, {0, 0, 0});
  RobotDrive drive{};
  drive.charge = 1;
  world.write(0, drive);
  for (int ms = 0; ms < 2000; ++ms) world.advance(1'000'000);
  const double full_V = world.sample_sensors(0).capacitor_V;
  EXPECT_NEAR(full_V, 200.0, 1e-6);
  drive.charge = 0;
  drive.kick = OMNIHIL_KICK_STRAIGHT;
  drive.kick_pulse_s = 5e-3;
  world.write(0, drive);
  world.advance(500'000);
  EXPECT_NEAR(world.ball()->velocity.x(), 5.0, 0.01);  // carpet and air for half a millisecond
  EXPECT_NEAR(world.plant().planar_state(0).v_x_m_s, -5.0 * 0.046 / 2.4, 0.01);
  EXPECT_LT(world.sample_sensors(0).capacitor_V, full_V);
  ASSERT_EQ(world.events().size(), 1u);
  EXPECT_EQ(world.events()[0].kind, WorldEventKind::kKick);
  // Held high it does not kick again.
  const double left_V = world.sample_sensors(0).capacitor_V;
  world.put_ball(0.0725 + kR + 0.009, 0.0, kR, {0, 0, 0});
  for (int ms = 0; ms < 10; ++ms) {
    world.write(0, drive);
    world.advance(1'000'000);
  }
  EXPECT_EQ(world.sample_sensors(0).capacitor_V, left_V);
}

TEST(World, AnEmptyCapacitorKicksNothing) {
  World world = make(1);
  world.put_ball(0.0725 + kR + 0.009, 0.0, kR, {0, 0, 0});
  RobotDrive drive{};
  drive.kick = OMNIHIL_KICK_STRAIGHT;
  drive.kick_pulse_s = 5e-3;
  world.write(0, drive);
  world.advance(1'000'000);
  EXPECT_EQ(world.ball()->velocity.norm(), 0.0);
}

TEST(World, AChipFliesOverARobot) {
  World world = make(2);
  world.put_robot(1, 0.9, 0.0, 0.0);
  world.put_ball(0.0725 + kR + 0.009, 0.0, kR, {0, 0, 0});
  RobotDrive drive{};
  drive.charge = 1;
  world.write(0, drive);
  world.advance(2'000'000'000);
  drive.kick = OMNIHIL_KICK_CHIP;
  drive.kick_pulse_s = 7e-3;
  world.write(0, drive);
  double highest_m = 0.0;
  for (int ms = 0; ms < 900; ++ms) {
    world.advance(1'000'000);
    highest_m = std::max(highest_m, world.ball()->position.z());
    for (const WorldEvent& e : world.events()) EXPECT_NE(e.kind, WorldEventKind::kBallTouch);
  }
  EXPECT_GT(highest_m, 0.5);
  EXPECT_GT(world.ball()->position.x(), 2.0);
}

TEST(World, ABallThatRollsIntoTheGoalIsAGoalOnce) {
  World world = make(1, {.field = &kFieldDivisionB});
  world.put_ball(4.0, 0.1, kR, {3.0, 0, 0});
  int goals = 0;
  for (int ms = 0; ms < 3000; ++ms) {
    world.advance(1'000'000);
    for (const WorldEvent& e : world.events())
      if (e.kind == WorldEventKind::kGoal) ++goals;
  }
  EXPECT_EQ(goals, 1);
  EXPECT_LT(world.ball()->position.x(), 4.5 + 0.18);
}

// Whether a ball stays at the bar of a robot that brakes steadily up to 5 m/s; at 7.5 m/s the carpet would be as fast as
// the ball's spun surface.
bool holds(double stiffness_N_per_m, double braking_m_s2) {
  WorldOptions options;
  options.ball.drag_coefficient = 0.0;
  BallHandling handling;
  handling.dribbler.mount_stiffness_N_per_m = stiffness_N_per_m;
  RobotModel model = sample_robot();
  model.handling = std::make_shared<const BallHandling>(handling);
  PlantOptions plant;
  plant.physics = Physics::kPlanar;
  World world(std::vector{model}, plant, options);
  const double touches_m = handling.dribbler.bar_x_m + 0.0228;  // where bar and ball just touch
  world.put_ball(touches_m - 0.5e-3, 0.0, kR, {-0.1, 0, 0});
  RobotDrive drive{};
  drive.dribbler_ratio = 1.0;
  world.write(0, drive);
  double v_m_s = 0.0, x_m = 0.0, time_s = -0.8;
  const double step_s = 0.5e-3;
  // The robot goes as it is told.
  while (v_m_s > -5.0 && world.ball()->position.x() - x_m < touches_m) {
    time_s += step_s;
    v_m_s -= braking_m_s2 * std::clamp(time_s / 0.3, 0.0, 1.0) * step_s;
    x_m += v_m_s * step_s;
    const PlanarState s = world.plant().planar_state(0);
    world.plant().shift(0, x_m - s.x_m, -s.y_m);
    world.set_velocity(0, v_m_s, 0.0, 0.0);
    world.advance(500'000);
  }
  return v_m_s <= -5.0;
}

TEST(World, TheDribblerHoldsTheBallUpToTheStatedAcceleration) {
  const double carpet = Carpet{}.sliding_friction;
  for (const double stiffness_N_per_m : {200.0, 300.0, 400.0}) {
    DribblerModel dribbler;
    dribbler.mount_stiffness_N_per_m = stiffness_N_per_m;
    const double most_m_s2 = held_acceleration_m_s2(dribbler, 0.0725, kR, 0.046, carpet);
    EXPECT_TRUE(holds(stiffness_N_per_m, 0.95 * most_m_s2)) << stiffness_N_per_m << ": " << most_m_s2;
    EXPECT_FALSE(holds(stiffness_N_per_m, 1.12 * most_m_s2)) << stiffness_N_per_m;
  }
}

TEST(World, ADribbledBallIsSeenByTheBeamAndLoadsTheMotor) {
  World world = make(1);
  world.put_ball(0.0797 + 0.0225, 0.0, kR, {-0.3, 0, 0});
  RobotDrive drive{};
  drive.dribbler_ratio = 1.0;
  world.write(0, drive);
  world.advance(1'500'000'000);
  EXPECT_EQ(world.sample_sensors(0).ball_seen, 1u);
  const double with_ball_A = world.handling(0).dribbler_current_A;
  world.take_ball_away();
  world.advance(1'500'000'000);
  EXPECT_EQ(world.sample_sensors(0).ball_seen, 0u);
  EXPECT_GT(with_ball_A, 1.5 * world.handling(0).dribbler_current_A);
}

TEST(World, SavedAndRestoredItGoesOnWithTheSameBits) {
  World world = make(3, {.field = &kFieldDivisionB});
  world.put_ball(0.5, 0.1, kR, {-2.0, 0, 0});
  const auto go = [&] {
    for (int ms = 0; ms < 300; ++ms) {
      for (int n = 0; n < 3; ++n) world.write(n, forward(0.4 * std::sin(0.01 * ms + n)));
      world.advance(1'000'000);
    }
    return world.save();
  };
  (void)go();
  const std::vector<std::uint8_t> saved = world.save();
  const std::vector<std::uint8_t> once = go();
  ASSERT_TRUE(world.restore(saved));
  EXPECT_EQ(go(), once);
  EXPECT_FALSE(world.restore(std::span(saved).first(10)));
}

double with_wheels_J(const World& world) {
  double sum_J = world.energy_J();
  for (int n = 0; n < world.plant().robot_count(); ++n)
    for (const double w : world.plant().truth(n).omega_wheel_rad_s)
      sum_J += 0.5 * spin_inertia_kg_m2(sample_robot()) * w * w;
  return sum_J;
}

// Coasting robots and a ball, thrown together at random in a small box: energy falls, nothing leaves, nothing breaks.
TEST(World, EnergyFallsThroughRandomHeaps) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  static constexpr FieldSize kBox{"box", 1200, 1000, 300, 100, 50, 100, 200};
  World world = make(6, {.field = &kBox});
  for (int round = 0; round < 40; ++round) {
    for (int n = 0; n < 6; ++n) {
      world.put_robot(n, 0.25 * (n % 3 - 1) + 0.02 * one(random), 0.3 * (n / 3) - 0.15, 3.1 * one(random));
      world.set_velocity(n, 2 * one(random), 2 * one(random), 8 * one(random));
    }
    world.put_ball(0.1 * one(random), 0.0, kR, {5 * one(random), 5 * one(random), 0.0});
    double energy_J = with_wheels_J(world);
    for (int ms = 0; ms < 500; ++ms) {
      world.advance(1'000'000);
      const double now_J = with_wheels_J(world);
      ASSERT_LT(now_J, energy_J + 1e-9) << "round " << round << " ms " << ms;
      energy_J = now_J;
      ASSERT_TRUE(world.ball()->position.allFinite());
      ASSERT_FALSE(world.plant().fault().has_value());
    }
  }
}

// Commands, teleports, kicks at random, into each other too: the state stays finite and no robot is far away.
// OMNIHIL_RANDOM_COMMANDS=1000000: as many as one has time for.
TEST(World, NothingBreaksIt) {
  const char* const asked = std::getenv("OMNIHIL_RANDOM_COMMANDS");
  const int commands = asked != nullptr ? std::atoi(asked) : 20'000;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  World world = make(4, {.field = &kFieldSeedPaper});
  world.put_ball(0, 0, kR, {0, 0, 0});
  for (int n = 0; n < commands; ++n) {
    const int who = static_cast<int>(random() % 4);
    switch (random() % 8) {
      case 0:
        world.put_robot(who, 0.2 * one(random), 0.2 * one(random), 4 * one(random));
        break;
      case 1:
        world.put_ball(3 * one(random), 2 * one(random), kR + std::max(0.0, one(random)),
                       {10 * one(random), 10 * one(random), 6 * one(random)});
        break;
      default: {
        RobotDrive d{};
        for (int i = 0; i < kWheels; ++i) {
          d.mode[i] = static_cast<std::uint32_t>(random() % 3);
          d.duty_ratio[i] = one(random);
        }
        d.dribbler_ratio = one(random);
        d.kick = static_cast<std::uint32_t>(random() % 3);
        d.kick_pulse_s = 0.02 * one(random);
        d.charge = static_cast<std::uint32_t>(random() % 2);
        world.write(who, d);
      }
    }
    world.advance(500'000);
    ASSERT_FALSE(world.plant().fault().has_value()) << n;
    ASSERT_TRUE(world.ball()->position.allFinite() && world.ball()->velocity.allFinite()) << n;
    ASSERT_LT(world.ball()->velocity.norm(), 40.0) << n;
    const PlanarState s = world.plant().planar_state(who);
    ASSERT_LT(std::hypot(s.x_m, s.y_m), 6.0) << n;
  }
}

}  // namespace
}  // namespace omnihil
