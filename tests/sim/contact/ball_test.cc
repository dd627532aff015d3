// The ball alone: closed forms of sliding, rolling, bouncing and flight; energy.
#include "sim/contact/ball.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace omnihil {
namespace {

constexpr double kG = 9.80665;

BallParams without_air() {
  BallParams p;
  p.drag_coefficient = 0.0;
  return p;
}

void run(const BallParams& p, const Carpet& c, BallState& b, double time_s, double step_s = 0.5e-3) {
  for (long i = 0; i < std::lround(time_s / step_s); ++i) advance_ball(p, c, b, step_s);
}

TEST(Ball, KickedFlatItRollsAtFiveSeventhsOfItsSpeed) {
  const BallParams p = without_air();
  const Carpet c;
  for (const double step_s : {0.1e-3, 0.5e-3, 4e-3}) {
    BallState b = resting_ball(p, 0, 0);
    b.velocity = {3.0, -4.0, 0.0};  // 5 m/s
    // slides for t = 2 v / (7 mu g), over 12 v^2 / (49 mu g)
    const double slides_s = 2.0 * 5.0 / (7.0 * c.sliding_friction * kG);
    run(p, c, b, std::ceil(slides_s / step_s) * step_s, step_s);
    const double rest_s = std::ceil(slides_s / step_s) * step_s - slides_s;
    const double a = c.rolling_resistance * kG;
    EXPECT_NEAR(b.velocity.norm(), 25.0 / 7.0 - a * rest_s, 1e-9);
    const double way_m =
        12.0 * 25.0 / (49.0 * c.sliding_friction * kG) + 25.0 / 7.0 * rest_s - 0.5 * a * rest_s * rest_s;
    EXPECT_NEAR(b.position.head<2>().norm(), way_m, 1e-9) << step_s;
    EXPECT_LT(floor_slip(p, b).norm(), 1e-9);
    EXPECT_NEAR(b.velocity.x() / b.velocity.y(), -0.75, 1e-9);
  }
}

TEST(Ball, RollingItStopsAfterVSquaredOverTwiceTheDeceleration) {
  const BallParams p = without_air();
  const Carpet c;
  BallState b = resting_ball(p, 1.0, 0.0);
  b.velocity = {1.2, 0, 0};
  b.spin = {0, 1.2 / p.radius_m, 0};
  run(p, c, b, 1.2 / (c.rolling_resistance * kG) + 0.1);
  EXPECT_EQ(b.velocity.norm(), 0.0);
  EXPECT_NEAR(b.position.x() - 1.0, 1.2 * 1.2 / (2.0 * c.rolling_resistance * kG), 1e-9);
}

TEST(Ball, BackspinBringsItBack) {
  const BallParams p = without_air();
  BallState b = resting_ball(p, 0, 0);
  b.velocity = {0.5, 0, 0};
  b.spin = {0, -200.0, 0};
  run(p, Carpet{}, b, 2.0);
  EXPECT_LT(b.velocity.x(), 0.0);
  // What is kept about the lowest point, m r v + I w, decides where it rolls: v = (v0 + 2/5 r w0) 5/7, then resistance
  BallState at_once = resting_ball(p, 0, 0);
  at_once.velocity = {0.5, 0, 0};
  at_once.spin = {0, -200.0, 0};
  const double rolls_s = (0.5 + 200.0 * p.radius_m) / (3.5 * Carpet{}.sliding_friction * kG);
  run(p, Carpet{}, at_once, std::ceil(rolls_s / 1e-4) * 1e-4, 1e-4);
  EXPECT_NEAR(at_once.velocity.x(), 5.0 / 7.0 * (0.5 - 0.4 * 200.0 * p.radius_m), 1e-4);
}

TEST(Ball, SideSpinDiesOut) {
  const BallParams p = without_air();
  const Carpet c;
  BallState b = resting_ball(p, 0, 0);
  b.spin = {0, 0, 50.0};
  const double slows = c.spinning_friction * kG / (0.4 * p.radius_m);
  run(p, c, b, 0.5);
  EXPECT_NEAR(b.spin.z(), 50.0 - 0.5 * slows, 1e-9);
  EXPECT_EQ(b.velocity.norm(), 0.0);
}

TEST(Ball, BouncesLoseHeightBySquareOfRestitution) {
  const BallParams p = without_air();
  const Carpet c;
  BallState b = resting_ball(p, 0, 0);
  b.position.z() += 0.5;
  b.on_floor = false;
  double highest_m = 0.0;
  int landings = 0;
  for (int i = 0; i < 20000 && landings < 2; ++i) {
    landings += advance_ball(p, c, b, 1e-4);
    if (landings == 1) highest_m = std::max(highest_m, b.position.z() - p.radius_m);
  }
  EXPECT_NEAR(highest_m, 0.5 * c.restitution * c.restitution, 1e-6);
  run(p, c, b, 5.0);
  EXPECT_TRUE(b.on_floor);
  EXPECT_EQ(b.position.z(), p.radius_m);
}

TEST(Ball, FlightLandsWhereTheParabolaDoes) {
  const BallParams p = without_air();
  BallState b = resting_ball(p, 0, 0);
  b.velocity = {4.0, 0, 4.0};
  b.on_floor = false;
  double landed_m = -1.0;
  while (landed_m < 0.0)
    if (advance_ball(p, Carpet{}, b, 1e-5) > 0) landed_m = b.position.x();
  EXPECT_NEAR(landed_m, 2.0 * 4.0 * 4.0 / kG, 1e-4);  // 4 m/s over at most one step after it
}

TEST(Ball, DragSlowsAFlyingBallAsItsLawSays) {
  BallParams p;
  BallState b = resting_ball(p, 0, 0);
  b.position.z() = 100.0;
  b.on_floor = false;
  b.velocity = {8.0, 0, 0};
  const double c =
      0.5 * p.air_density_kg_m3 * p.drag_coefficient * M_PI * p.radius_m * p.radius_m / p.mass_kg;
  run(p, Carpet{}, b, 0.1, 1e-5);
  EXPECT_NEAR(b.velocity.x(), 8.0 / (1.0 + c * 8.0 * 0.1), 5e-4);  // gravity's speed adds to |v| a little
}

TEST(Ball, LiftTurnsAndDoesNoWork) {
  BallParams p = without_air();
  p.lift_coefficient = 1.0;
  BallState b = resting_ball(p, 0, 0);
  b.position.z() = 50.0;
  b.on_floor = false;
  b.velocity = {6.0, 0, 0};
  b.spin = {0, 0, 100.0};
  const double energy_J = ball_energy_J(p, b);
  run(p, Carpet{}, b, 0.5, 1e-4);
  EXPECT_GT(b.velocity.y(), 0.1);
  EXPECT_NEAR(ball_energy_J(p, b), energy_J, 1e-6 * energy_J);
}

TEST(Ball, TheNapTurnsARollingBallAndLetsItRunFurtherAlong) {
  const BallParams p = without_air();
  Carpet c;
  c.nap_ratio = 0.3;
  const auto rolled = [&](double yaw_rad) {
    BallState b = resting_ball(p, 0, 0);
    b.velocity = {std::cos(yaw_rad), std::sin(yaw_rad), 0.0};
    b.spin = {-b.velocity.y() / p.radius_m, b.velocity.x() / p.radius_m, 0.0};
    run(p, c, b, 10.0);
    return b.position;
  };
  const double along_m = rolled(0.0).x(), against_m = -rolled(M_PI).x();
  EXPECT_NEAR(along_m / against_m, 1.3 / 0.7, 1e-6);
  EXPECT_GT(rolled(0.5 * M_PI).x(), 0.05);
}

TEST(Ball, APatchHasItsOwnResistance) {
  const BallParams p = without_air();
  Carpet c;
  c.patches.push_back({-1, 100, -1, 1, 1.0, 2.0});
  BallState b = resting_ball(p, 0, 0);
  b.velocity = {1.0, 0, 0};
  b.spin = {0, 1.0 / p.radius_m, 0};
  run(p, c, b, 10.0);
  EXPECT_NEAR(b.position.x(), 1.0 / (4.0 * c.rolling_resistance * kG), 1e-9);
}

TEST(Ball, EnergyIsNeverCreated) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  BallParams p;
  for (int run_number = 0; run_number < 2000; ++run_number) {
    Carpet c;
    c.nap_ratio = 0.45 * (1.0 + one(random));
    c.nap_rad = 3.0 * one(random);
    BallState b = resting_ball(p, 0, 0);
    b.on_floor = one(random) > 0.0;
    b.position.z() += b.on_floor ? 0.0 : 0.3 * (1.0 + one(random));
    b.velocity = {8 * one(random), 8 * one(random), b.on_floor ? 0.0 : 5 * one(random)};
    b.spin = {400 * one(random), 400 * one(random), 100 * one(random)};
    double energy_J = ball_energy_J(p, b);
    for (int i = 0; i < 400; ++i) {
      advance_ball(p, c, b, 1e-3);
      const double now_J = ball_energy_J(p, b);
      ASSERT_LE(now_J, energy_J + 1e-12) << "run " << run_number << " step " << i;
      ASSERT_GE(b.position.z(), p.radius_m - 1e-12);
      energy_J = now_J;
    }
  }
}

}  // namespace
}  // namespace omnihil
