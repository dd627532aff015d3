// Impulses: closed forms of two bodies, momentum, and energy that is never created.
#include "sim/contact/contact_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace omnihil {
namespace {

TEST(ContactSolver, TwoRobotsMeetHeadOnWithTheirRestitution) {
  ContactSolver solver;
  const int a = solver.add(planar_contact_body(2.0, 0.01, {0, 0}, {1.0, 0}, 0));
  const int b = solver.add(planar_contact_body(3.0, 0.01, {0.18, 0}, {-0.5, 0}, 0));
  solver.touch({.a = b, .b = a, .point = {0.09, 0, 0}, .normal = {1, 0, 0}, .restitution = 0.4});
  solver.solve(1e-3);
  const double together = (2.0 * 1.0 - 3.0 * 0.5) / 5.0;
  EXPECT_NEAR(solver.body(a).velocity.x(), together - 0.4 * 1.5 * 3.0 / 5.0, 1e-9);
  EXPECT_NEAR(solver.body(b).velocity.x(), together + 0.4 * 1.5 * 2.0 / 5.0, 1e-9);
}

TEST(ContactSolver, ASlidingBallAtAWallTakesSpinByTheLawOfAFullSphere) {
  // Cross 2002: with much friction the slip stops: v_t' = 5/7 v_t
  ContactSolver solver;
  const BallParams p;
  BallState ball = resting_ball(p, 0, 0);
  ball.velocity = {2.0, 1.0, 0.0};
  const int b = solver.add(ball_contact_body(p, ball));
  solver.touch({.a = b,
                .b = ContactSolver::kFixed,
                .point = ball.position + Vector3(p.radius_m, 0, 0),
                .normal = {-1, 0, 0},
                .restitution = 0.5,
                .friction = 10.0});
  solver.solve(1e-3);
  EXPECT_NEAR(solver.body(b).velocity.x(), -1.0, 1e-9);
  EXPECT_NEAR(solver.body(b).velocity.y(), 5.0 / 7.0, 1e-6);
  EXPECT_NEAR(std::abs(solver.body(b).spin.z()), 5.0 / 7.0 / p.radius_m, 1e-3);
}

TEST(ContactSolver, FrictionIsAtMostItsShareOfTheImpulse) {
  ContactSolver solver;
  const BallParams p;
  BallState ball = resting_ball(p, 0, 0);
  ball.velocity = {2.0, 5.0, 0.0};
  const int b = solver.add(ball_contact_body(p, ball));
  solver.touch({.a = b,
                .b = ContactSolver::kFixed,
                .point = ball.position + Vector3(p.radius_m, 0, 0),
                .normal = {-1, 0, 0},
                .restitution = 0.0,
                .friction = 0.1});
  solver.solve(1e-3);
  EXPECT_NEAR(solver.body(b).velocity.y(), 5.0 - 0.1 * 2.0, 1e-9);
}

TEST(ContactSolver, ASlowMeetingDoesNotBounce) {
  ContactSolver solver;
  const int a = solver.add(planar_contact_body(2.0, 0.01, {0, 0}, {0.04, 0}, 0));
  solver.touch(
      {.a = a, .b = ContactSolver::kFixed, .point = {0.09, 0, 0}, .normal = {-1, 0, 0}, .restitution = 0.9});
  solver.solve(1e-3);
  EXPECT_NEAR(solver.body(a).velocity.x(), 0.0, 1e-12);
}

TEST(ContactSolver, ASoftContactIsASpringAndADamper) {
  ContactSolver solver;
  const BallParams p;
  const int b = solver.add(ball_contact_body(p, resting_ball(p, 0, 0)));
  Contact c{.a = b, .b = ContactSolver::kFixed, .normal = {1, 0, 0}};
  c.point = {0, 0, p.radius_m};
  c.stiffness_N_per_m = 800.0;
  c.damping_N_s_per_m = 4.0;
  c.depth_m = 1e-3;
  solver.touch(c);
  const double h = 1e-6;
  solver.solve(h);
  EXPECT_NEAR(solver.body(b).velocity.x(), 800.0 * 1e-3 * h / p.mass_kg, 1e-8);
}

TEST(ContactSolver, ARollerGivesItsSpinAway) {
  ContactSolver solver;
  const BallParams p;
  const int b = solver.add(ball_contact_body(p, resting_ball(p, 0, 0)));
  const int r = solver.add(Roller{{0, 1, 0}, 0.007, 1.0 / 4.8e-6, 500.0});
  Contact c{.a = b, .b = ContactSolver::kFixed, .normal = {1, 0, 0}};
  c.point = {-p.radius_m, 0, p.radius_m};
  c.friction = 0.8;
  c.stiffness_N_per_m = 800.0;
  c.depth_m = 1e-3;
  c.roller = r;
  solver.touch(c);
  solver.solve(1e-4);
  const double lost = 4.8e-6 * (500.0 - solver.roller(r).omega_rad_s);
  // What the bar loses about its axis, the ball has about its own, by the radii: both feel the same force.
  EXPECT_GT(lost, 0.0);
  EXPECT_NEAR(solver.body(b).spin.y() * p.inertia_kg_m2() / p.radius_m, -lost / 0.007, 1e-9);
}

// Random heaps of bodies and contacts: total momentum stays, energy does not grow.
TEST(ContactSolver, MomentumStaysAndEnergyIsNeverCreated) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const BallParams p;
  ContactSolver solver;
  for (int n = 0; n < 100000; ++n) {
    solver.clear();
    double mass[3] = {p.mass_kg, 1.0 + 3.0 * share(random), 1.0 + 3.0 * share(random)};
    BallState ball = resting_ball(p, 0.05 * one(random), 0.05 * one(random));
    ball.velocity = {8 * one(random), 8 * one(random), one(random)};
    ball.spin = {300 * one(random), 300 * one(random), 300 * one(random)};
    solver.add(ball_contact_body(p, ball));
    for (int i = 1; i < 3; ++i)
      solver.add(planar_contact_body(mass[i], 0.01 * (0.5 + share(random)),
                                     {0.1 * one(random), 0.1 * one(random)},
                                     {3 * one(random), 3 * one(random)}, 10 * one(random)));
    Vector3 momentum(0, 0, 0);
    for (int i = 0; i < 3; ++i) momentum += mass[i] * solver.body(i).velocity;
    const double before_J = solver.kinetic_energy_J();
    const int contacts = 1 + static_cast<int>(3.0 * share(random));
    for (int i = 0; i < contacts; ++i) {
      Contact c;
      c.a = i == 1 ? 1 : 0;
      c.b = i == 0 ? 1 : 2;
      const double angle = 3.14 * one(random);
      c.normal = {std::cos(angle), std::sin(angle), 0.0};
      c.point = solver.body(c.a).center - (c.a == 0 ? p.radius_m : 0.09) * c.normal;
      c.restitution = share(random);
      c.friction = 2.0 * share(random);
      solver.touch(c);
    }
    solver.solve(1e-3);
    Vector3 after(0, 0, 0);
    for (int i = 0; i < 3; ++i) after += mass[i] * solver.body(i).velocity;
    ASSERT_NEAR((after - momentum).head<2>().norm(), 0.0, 1e-9) << n;
    ASSERT_LE(solver.kinetic_energy_J(), before_J * (1.0 + 1e-12)) << n;
  }
}

}  // namespace
}  // namespace omnihil
