// Outlines: distances against a brute-force search over their points.
#include "sim/contact/convex_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace omnihil {
namespace {

// Points of a robot's outline, densely.
std::vector<Vector2> outline_points(const RobotOutline& o, double x_m, double y_m, double yaw_rad) {
  std::vector<Vector2> points;
  for (int i = 0; i < 7200; ++i) {
    const double a = 2.0 * M_PI * i / 7200;
    double r = o.radius_m;
    if (r * std::cos(a) > o.front_m) r = o.front_m / std::cos(a);
    points.emplace_back(x_m + r * std::cos(a + yaw_rad), y_m + r * std::sin(a + yaw_rad));
  }
  return points;
}

TEST(ConvexShape, DistanceOfTwoRobotsIsThatOfTheirPoints) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  const RobotOutline o;
  int looked_at = 0;
  for (int n = 0; n < 400; ++n) {
    const double x = 0.2 * one(random), y = 0.2 * one(random), a = 3 * one(random), b = 3 * one(random);
    const Touch touch = touch_of(robot_shape(o, 0, 0, a), robot_shape(o, x, y, b));
    if (touch.depth_m > 0.0 || std::hypot(x, y) > 2.0 * o.radius_m) continue;
    const auto pa = outline_points(o, 0, 0, a), pb = outline_points(o, x, y, b);
    double least = 1.0;
    for (std::size_t i = 0; i < pa.size(); i += 4)
      for (std::size_t k = 0; k < pb.size(); k += 4) least = std::min(least, (pa[i] - pb[k]).norm());
    EXPECT_NEAR(-touch.depth_m, least, 3e-4);
    ++looked_at;
  }
  EXPECT_GT(looked_at, 5);
}

TEST(ConvexShape, FlatAgainstFlatTouchesInTwoPoints) {
  const RobotOutline o;
  const double apart_m = 2.0 * o.front_m - 1e-3;
  const Touch touch = touch_of(robot_shape(o, 0, 0, 0), robot_shape(o, apart_m, 0.02, M_PI));
  EXPECT_NEAR(touch.depth_m, 1e-3, 1e-9);
  ASSERT_EQ(touch.point_count, 2u);
  EXPECT_NEAR(touch.normal.x(), 1.0, 1e-9);
  const double half_m = o.half_front_m();
  EXPECT_NEAR(std::min(touch.points[0].y(), touch.points[1].y()), -half_m + 0.02, 1e-9);
  EXPECT_NEAR(std::max(touch.points[0].y(), touch.points[1].y()), half_m, 1e-9);
  EXPECT_NEAR(touch.points[0].x(), o.front_m - 0.5e-3, 1e-9);
}

TEST(ConvexShape, RoundAgainstRoundTouchesBetweenTheMiddles) {
  const RobotOutline o;
  const Touch touch = touch_of(robot_shape(o, 0, 0, M_PI), robot_shape(o, 0.12, 0.09, 0.5));
  EXPECT_NEAR(touch.depth_m, 2.0 * o.radius_m - 0.15, 1e-9);
  EXPECT_NEAR(touch.normal.x(), 0.8, 1e-9);
  ASSERT_EQ(touch.point_count, 1u);
  EXPECT_NEAR(touch.points[0].x(), 0.06, 1e-9);
  EXPECT_NEAR(touch.points[0].y(), 0.045, 1e-9);
}

TEST(ConvexShape, ABoxIsMetAtItsSideAndAtItsCorner) {
  const RobotOutline o;
  const ConvexShape box = box_shape(1.0, 1.02, -0.5, 0.5);
  const Touch side = touch_of(robot_shape(o, 0.92, 0.1, M_PI), box);
  EXPECT_NEAR(side.depth_m, 0.01, 1e-9);
  EXPECT_NEAR(side.normal.x(), 1.0, 1e-9);
  const Touch corner = touch_of(robot_shape(o, 1.0 - 0.06, 0.5 + 0.06, M_PI), box);
  EXPECT_NEAR(corner.depth_m, o.radius_m - 0.06 * std::sqrt(2.0), 1e-9);
}

TEST(ConvexShape, NearestOnAnOutlineIsTheNearestOfItsPoints) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> one(-0.15, 0.15);
  const RobotOutline o;
  const auto points = outline_points(o, 0, 0, 0);
  for (int n = 0; n < 500; ++n) {
    const Vector2 p(one(random), one(random));
    const Nearest nearest = nearest_on(o, p);
    double least = 1.0;
    for (const Vector2& q : points) least = std::min(least, (p - q).norm());
    EXPECT_NEAR(std::abs(nearest.distance_m), least, 1e-4);
    const bool inside = p.norm() < o.radius_m && p.x() < o.front_m;
    EXPECT_EQ(nearest.distance_m < 0.0, inside);
    EXPECT_NEAR(nearest.normal.norm(), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace omnihil
