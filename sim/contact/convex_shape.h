// Outlines on the floor that can touch: a robot (a circle with a flat front), a wall or a goal's board (a box).
//
//   ConvexShape a = robot_shape({.radius_m = 0.09, .front_m = 0.072}, x_m, y_m, yaw_rad);
//   ConvexShape b = box_shape(4.5, 4.52, -0.5, 0.5);
//   Touch touch = touch_of(a, b);                        // touch.depth_m > 0: they overlap
//
// Law: for convex A, B with support functions h, the separation is the largest over directions n of
//   s(n) = -h_A(n) - h_B(-n)   (h about the field's origin; n from A to B)
// and the largest is at a direction between two features: centre to centre of arcs, a flat side's normal, corner to
// centre, corner to corner. Those are looked at, so that the separation is exact where the shapes are apart, and the
// smallest way out where they overlap (separating axis theorem; Ericson 2005, "Real-Time Collision Detection", ch. 5).
// Where both are flat the touch has two points, the ends of what they share.
// Cannot: hollow outlines (a robot's wheels behind its hull), anything that depends on height.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace omnihil {

using Vector2 = Eigen::Vector2d;

// Seen from above, body frame: a circle about the geometric centre, cut at x = front_m.
struct RobotOutline {
  double radius_m = 0.09;   // rules: at most 0.09
  double front_m = 0.0725;  // centre to the flat front
  double height_m = 0.15;
  double half_front_m() const;  // half the flat front's width
};

struct ConvexShape {
  Vector2 center{0, 0};       // of the arc; of a box its middle
  double arc_radius_m = 0.0;  // 0: no arc
  double arc_cos = 0.0;       // directions whose cosine with `front` is above it belong to the flat
  Vector2 front{1, 0};
  std::size_t corner_count = 0, normal_count = 0;
  std::array<Vector2, 4> corners{}, normals{};
  double reach_m = 0.0;  // radius about the centre that holds all of it

  double support_m(const Vector2& n) const;  // largest n . p over its points
};

ConvexShape robot_shape(const RobotOutline& outline, double x_m, double y_m, double yaw_rad);
ConvexShape box_shape(double x_from_m, double x_to_m, double y_from_m, double y_to_m);

struct Touch {
  double depth_m = -1.0;  // negative: the distance between them
  Vector2 normal{1, 0};   // from a to b
  std::size_t point_count = 0;
  std::array<Vector2, 2> points{};  // field frame, between the two surfaces
};
Touch touch_of(const ConvexShape& a, const ConvexShape& b);
// With what lies beyond a straight wall: all points of which n . p > offset_m.
Touch touch_of_wall(const ConvexShape& a, const Vector2& n, double offset_m);

// The outline's point next to p (body frame), the outward normal there, and the distance; negative: p is inside.
struct Nearest {
  Vector2 point, normal;
  double distance_m = 0.0;
};
Nearest nearest_on(const RobotOutline& outline, const Vector2& p);

}  // namespace omnihil
