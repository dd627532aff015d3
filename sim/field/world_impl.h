// The state of a world and what happens at the end of each mechanical step; world.h says what it does.
#pragma once
#include <array>
#include <vector>

#include "sim/field/world.h"
#include "sim/robot/ball_handling.h"
#include "sim/robot/planar_law.h"

namespace omnihil {

// world_tips.cc: tilt at which it falls.
double tipping_angle_rad(const RobotModel& model);

struct World::Impl : StepListener {
  Impl(std::span<const RobotModel> robots, const PlantOptions& plant_options, const WorldOptions& options);
  void after_step(Plant&, double step_s) override;

  // world_handling.cc
  void handle_ball(std::size_t robot, double step_s);
  void begin_kick(std::size_t robot, const RobotDrive& drive);
  void kick_ball(std::size_t robot);
  Vector3 in_body(std::size_t robot, const Vector3& field_point) const;
  // world_contacts.cc
  void touch_all(double step_s);
  void touch_robots(std::size_t a, std::size_t b);
  void put_touch(const Touch& touch, int first, int second, int who_first, int who_second);
  void touch_walls(std::size_t robot);
  void touch_ball_with_robot(std::size_t robot);
  void touch_ball_with_walls();
  void touch_robot_with_mover(std::size_t robot, std::size_t mover);
  void touch_ball_with_mover(std::size_t mover);
  void touch_ball_with_hull(const RobotOutline& outline, const PlanarState& state, double restitution,
                            double friction, int who);
  int body_of_mover(std::size_t mover);
  // world_tips.cc
  void look_for_tips();
  void touch_bar(std::size_t robot, const Vector3& ball_in_body);
  void give_back();
  void move_apart();

  double now_s() const { return 1e-9 * static_cast<double>(plant.now_ns()); }
  int body_of(std::size_t robot);
  int body_of_ball();
  void report(WorldEventKind kind, int robot, int other, double x_m, double y_m, double size);

  // Who: a robot's index; kBallWho; a mover's kFirstMover - index.
  static constexpr int kBallWho = -2, kFirstMover = -3;
  // A pair that overlaps, to be moved apart along n: from b to a; -1: fixed.
  struct Overlap {
    int a, b;
    Vector3 normal;
    double depth_m;
  };
  struct Part {
    double mass_kg, inertia_kg_m2;  // about the centre of mass
    Vector2 com;                    // body frame
    const BallHandling* handling;
  };

  WorldOptions options;
  std::vector<RobotModel> models;  // keep the handlings alive
  Plant plant;
  std::vector<Part> parts;
  std::array<Board, 6> boards{};
  std::array<ConvexShape, 6> board_shapes{};
  // state
  bool has_ball = false;
  BallState ball;
  std::vector<HandlingState> handling;
  std::vector<char> here, tipped;
  std::int64_t steps = 0;
  int goal_side = 0;
  // of one step
  std::vector<RobotDrive> drives;
  std::vector<PlanarState> states;
  std::vector<ConvexShape> shapes;
  std::vector<char> shape_known;
  std::vector<int> body, roller;
  int ball_body = -1;
  ContactSolver solver;
  std::vector<Mover> movers;
  std::vector<ConvexShape> mover_shapes;
  std::vector<int> mover_body;
  std::vector<double> tip_rad;  // tilt at which the centre of mass is over the wheels' edge
  std::int64_t clock_offset_ns = 0;
  std::vector<Overlap> overlaps;
  std::vector<std::pair<int, int>> touching, touched_before;
  std::vector<WorldEvent> events;
  const ConvexShape& shape_of(std::size_t robot);
};

}  // namespace omnihil
