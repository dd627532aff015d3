// The field with everything on it: robots of both teams (a plant of motors and wheels), the ball, boards and goals, and
// what happens where they touch.
//
//   World world(robots, {.physics = Physics::kPlanar}, {.field = &kFieldDivisionB});
//   world.put_ball(1.0, 0.0, 0.0215, {2.0, 0.0, 0.0});
//   world.write(0, drive);                          // duties, dribbler, kick, charge
//   world.advance(1'000'000);
//   RobotSensors s = world.sample_sensors(0);       // with ball_seen and the capacitor's voltage
//
// One mechanical step: the plant's (plant.h), then at its end: chargers, dribbler motors and break beams; kicks; the
// ball's free motion (ball.h); impulses of all that touch (contact_solver.h); and what overlaps is moved apart, positions
// only, so that it does no work. A robot that touches nothing has the bits it has in a plant alone. A kick gives the ball
// its speed relative to the robot at the plunger, and the robot the recoil.
// Movers are bodies that follow their own course whatever they meet: real robots in a mixed match.
// Tipping: a free body whose tilt brings its centre of mass over the edge of its wheels; the other physics refuse a robot
// that could.
// Planar physics and Simbody take the same contacts, since both give a robot's planar motion; a free body (it can tip)
// takes them as planar impulses: what would tip it by a push at its height is left out.
// Cannot: robots that drive onto the ball, balls under a chassis, more than one ball.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/contact/contact_solver.h"
#include "sim/field/break_beam.h"
#include "sim/field/field_size.h"
#include "sim/robot/plant.h"

namespace omnihil {

struct WorldOptions {
  const FieldSize* field = nullptr;  // null: an open floor
  bool contacts = true;              // robots with robots and walls; the ball's contacts are always there
  bool handling = true;              // kickers, dribblers, break beams
  BallParams ball{};
  Carpet carpet{};
  double wall_restitution = 0.5, wall_friction = 0.3;  // guess, +-30 %
};

// What a robot has done with the ball, and feels of it.
struct HandlingState {
  double capacitor_V = 0.0;
  double omega_bar_rad_s = 0.0;
  double dribbler_current_A = 0.0;
  BeamMemory beam;
  bool ball_seen = false;
  double kick_until_s = -1.0;  // plunger out
  double kick_speed_m_s = 0.0, kick_angle_rad = 0.0, kick_k = 0.0;
  bool kick_asked = false;  // as the firmware's output was last
  bool chips = false;
};

// Held bodies: speeds are what they are whatever touches them, and they go on by them until told again.
struct Mover {
  PlanarState state;
  RobotOutline outline;
};

enum class WorldEventKind : std::uint8_t { kKick, kRobotsTouch, kBallTouch, kGoal, kTip };
struct WorldEvent {
  WorldEventKind kind = WorldEventKind::kKick;
  std::int64_t now_ns = 0;
  int robot = -1, other = -1;  // a goal: robot is +1 or -1, the side
  double x_m = 0, y_m = 0;
  double size = 0;  // speed of a kick, impulse of a touch
};

class World {
 public:
  World(std::span<const RobotModel> robots, const PlantOptions& plant, const WorldOptions& options);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  Plant& plant();
  const Plant& plant() const;
  const WorldOptions& options() const;
  std::int64_t now_ns() const;

  void put_ball(double x_m, double y_m, double z_m, const Vector3& velocity, const Vector3& spin = {0, 0, 0});
  void take_ball_away();
  const BallState* ball() const;  // null: there is none
  void put_robot(int robot, double x_m, double y_m, double yaw_rad);
  void set_velocity(int robot, double v_x_m_s, double v_y_m_s, double omega_rad_s);
  void set_present(int robot, bool present);  // an absent one touches nothing and is not seen
  bool present(int robot) const;

  // In force until set again; not part of save().
  void set_movers(std::span<const Mover> movers);
  std::span<const Mover> movers() const;

  void write(int robot, const RobotDrive& drive);
  void advance(std::int64_t duration_ns);
  RobotSensors sample_sensors(int robot);
  const HandlingState& handling(int robot) const;
  // What happened in the last advance().
  std::span<const WorldEvent> events() const;
  double energy_J()
      const;  // kinetic of bodies and ball, and the ball's potential; wheels and motors left out

  // Whole state; restored, time is what it was then. Events tell times of now_ns() + offset, for a caller whose clock
  // goes on.
  void set_clock_offset(std::int64_t offset_ns);
  std::vector<std::uint8_t> save() const;
  bool restore(std::span<const std::uint8_t> bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil
