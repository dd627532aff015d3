#include "sim/contact/convex_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace omnihil {
namespace {

constexpr double kFlat_m = 1e-6;  // corners that far from the support line still lie on it

Vector2 rotated(const Vector2& v, double cos_yaw, double sin_yaw) {
  return {cos_yaw * v.x() - sin_yaw * v.y(), sin_yaw * v.x() + cos_yaw * v.y()};
}

// The points of a shape on its support line along n: one, or the two ends of a flat side.
std::size_t support_points(const ConvexShape& s, const Vector2& n, std::array<Vector2, 2>& out) {
  const double h_m = s.support_m(n);
  if (s.arc_radius_m > 0.0 && n.dot(s.front) <= s.arc_cos) {
    out[0] = s.center + s.arc_radius_m * n;
    return 1;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.corner_count && count < 2; ++i) {
    if (n.dot(s.corners[i]) >= h_m - kFlat_m) out[count++] = s.corners[i];
  }
  return count;
}

struct Search {
  const ConvexShape& a;
  const ConvexShape& b;
  Touch best{};
  double separation_m = -std::numeric_limits<double>::infinity();

  void look(const Vector2& n) {
    const double s_m = -a.support_m(n) - b.support_m(-n);
    if (s_m <= separation_m) return;
    separation_m = s_m;
    best.normal = n;
  }
  void look_along(const Vector2& way) {
    const double length_m = way.norm();
    if (length_m > 1e-9) look(way / length_m);
  }
};

}  // namespace

double RobotOutline::half_front_m() const {
  return std::sqrt(std::max(0.0, radius_m * radius_m - front_m * front_m));
}

double ConvexShape::support_m(const Vector2& n) const {
  if (arc_radius_m > 0.0 && n.dot(front) <= arc_cos) return n.dot(center) + arc_radius_m;
  double most_m = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corner_count; ++i) most_m = std::max(most_m, n.dot(corners[i]));
  return most_m;
}

ConvexShape robot_shape(const RobotOutline& outline, double x_m, double y_m, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad), half_m = outline.half_front_m();
  ConvexShape shape;
  shape.center = {x_m, y_m};
  shape.arc_radius_m = shape.reach_m = outline.radius_m;
  shape.arc_cos = outline.front_m / outline.radius_m;
  shape.front = {c, s};
  shape.corner_count = 2;
  shape.corners[0] = shape.center + rotated({outline.front_m, -half_m}, c, s);
  shape.corners[1] = shape.center + rotated({outline.front_m, half_m}, c, s);
  shape.normal_count = 1;
  shape.normals[0] = shape.front;
  return shape;
}

ConvexShape box_shape(double x_from_m, double x_to_m, double y_from_m, double y_to_m) {
  ConvexShape shape;
  shape.center = {0.5 * (x_from_m + x_to_m), 0.5 * (y_from_m + y_to_m)};
  shape.corner_count = shape.normal_count = 4;
  shape.corners = {Vector2(x_from_m, y_from_m), Vector2(x_to_m, y_from_m), Vector2(x_to_m, y_to_m),
                   Vector2(x_from_m, y_to_m)};
  shape.normals = {Vector2(1, 0), Vector2(-1, 0), Vector2(0, 1), Vector2(0, -1)};
  shape.reach_m = (shape.corners[0] - shape.center).norm();
  return shape;
}

Touch touch_of(const ConvexShape& a, const ConvexShape& b) {
  Search search{a, b};
  const double apart_m = (b.center - a.center).norm() - a.reach_m - b.reach_m;
  if (apart_m > 0.0) {
    search.best.depth_m = -apart_m;
    return search.best;
  }
  const bool both_round = a.arc_radius_m > 0.0 && b.arc_radius_m > 0.0;
  if (both_round) search.look_along(b.center - a.center);
  for (std::size_t i = 0; i < a.normal_count; ++i) search.look(a.normals[i]);
  for (std::size_t i = 0; i < b.normal_count; ++i) search.look(-b.normals[i]);
  for (std::size_t i = 0; i < a.corner_count; ++i) {
    if (b.arc_radius_m > 0.0) search.look_along(b.center - a.corners[i]);
    for (std::size_t k = 0; k < b.corner_count; ++k) search.look_along(b.corners[k] - a.corners[i]);
  }
  if (a.arc_radius_m > 0.0) {
    for (std::size_t k = 0; k < b.corner_count; ++k) search.look_along(b.corners[k] - a.center);
  }
  Touch& touch = search.best;
  touch.depth_m = -search.separation_m;
  if (touch.depth_m <= 0.0) return touch;

  const Vector2& n = touch.normal;
  std::array<Vector2, 2> pa, pb;
  const std::size_t count_a = support_points(a, n, pa), count_b = support_points(b, -n, pb);
  const double middle_m = 0.5 * (a.support_m(n) - b.support_m(-n));  // of the overlap, along n
  const Vector2 along(-n.y(), n.x());
  const auto put = [&](double t) { touch.points[touch.point_count++] = middle_m * n + t * along; };
  if (count_a == 1 && count_b == 1) {
    put(0.5 * (along.dot(pa[0]) + along.dot(pb[0])));
  } else if (count_a == 1) {
    put(along.dot(pa[0]));
  } else if (count_b == 1) {
    put(along.dot(pb[0]));
  } else {
    const auto [a_from, a_to] = std::minmax({along.dot(pa[0]), along.dot(pa[1])});
    const auto [b_from, b_to] = std::minmax({along.dot(pb[0]), along.dot(pb[1])});
    put(std::max(a_from, b_from));
    put(std::min(a_to, b_to));
  }
  return touch;
}

Touch touch_of_wall(const ConvexShape& a, const Vector2& n, double offset_m) {
  Touch touch;
  touch.normal = n;
  touch.depth_m = n.dot(a.center) + a.reach_m - offset_m;
  if (touch.depth_m <= 0.0) return touch;
  touch.depth_m = a.support_m(n) - offset_m;
  if (touch.depth_m > 0.0) touch.point_count = support_points(a, n, touch.points);
  return touch;
}

Nearest nearest_on(const RobotOutline& o, const Vector2& p) {
  const double half_m = o.half_front_m(), length_m = p.norm();
  const Vector2 outward = length_m > 1e-12 ? Vector2(p / length_m) : Vector2(-1, 0);
  const Nearest arc{o.radius_m * outward, outward, length_m - o.radius_m};
  const bool before_flat = std::abs(p.y()) <= half_m;
  const Nearest flat{{o.front_m, p.y()}, {1, 0}, p.x() - o.front_m};
  const bool inside = p.x() < o.front_m && length_m < o.radius_m;
  if (inside) return before_flat && flat.distance_m > arc.distance_m ? flat : arc;
  if (before_flat && p.x() >= o.front_m) return flat;
  if (outward.x() * o.radius_m <= o.front_m) return arc;
  const Vector2 corner(o.front_m, p.y() > 0.0 ? half_m : -half_m);
  const Vector2 way = p - corner;
  const double distance_m = way.norm();
  return {corner, distance_m > 1e-12 ? Vector2(way / distance_m) : Vector2(1, 0), distance_m};
}

}  // namespace omnihil
