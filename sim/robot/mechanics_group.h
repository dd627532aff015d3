// Robots whose mechanics are one system, with the state of all of them: what a plant advances at once, or on one core.
//
//   MechanicsGroup group(first, make_mechanics(models, Physics::kSimbody, floors), models.size());
//   group.set_state();                                     // floor forces at group.q and group.u
//   BodyMotion motion = group.motion(robot);               // by its number among all robots
//
// What a robot does is the same bits whichever robots it shares a group with.
#pragma once
#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "sim/robot/chassis.h"
#include "sim/robot/integrate.h"
#include "sim/robot/planar.h"

namespace omnihil {

using Mechanics = std::variant<PlanarMechanics, Chassis>;

inline Mechanics make_mechanics(const std::vector<RobotModel>& robots, Physics physics,
                                const std::vector<const FloorEffects*>& effects) {
  if (physics == Physics::kPlanar) return PlanarMechanics(robots, effects);
  return Chassis(robots, physics == Physics::kSimbody ? Chassis::Joint::kPlanar : Chassis::Joint::kFree,
                 effects);
}

struct MechanicsGroup {
  MechanicsGroup(std::size_t first_, Mechanics mechanics_, std::size_t robots_)
      : first(first_),
        robots(robots_),
        mechanics(std::move(mechanics_)),
        layout(std::visit([](const auto& m) { return m.layout(); }, mechanics)),
        q(robots_ * layout.q_per_robot),
        u(robots_ * layout.u_per_robot),
        u_before(u.size()),
        scratch(q.size(), u.size()),
        torques(robots_) {}

  // Brings the floor forces up to date with q and u.
  void set_state() {
    if (!state_known) std::visit([&](auto& back) { back.set_state(q, u); }, mechanics);
    state_known = true;
  }
  // First of a robot's positions and speeds.
  double* pose(std::size_t robot) { return &q[(robot - first) * layout.q_per_robot]; }
  const double* pose(std::size_t robot) const { return &q[(robot - first) * layout.q_per_robot]; }
  double* speeds(std::size_t robot) { return &u[(robot - first) * layout.u_per_robot]; }
  const double* speeds(std::size_t robot) const { return &u[(robot - first) * layout.u_per_robot]; }
  BodyMotion motion(std::size_t robot) const {
    return std::visit([&](const auto& back) { return back.motion(q, u, robot - first); }, mechanics);
  }
  void place(std::size_t robot, double x_m, double y_m, double yaw_rad) {
    std::visit([&](const auto& back) { back.place(q, u, robot - first, x_m, y_m, yaw_rad); }, mechanics);
    state_known = false;
  }
  void lift(std::size_t robot, const PerWheel<bool>& lifted) {
    std::visit([&](auto& back) { back.lift(robot - first, lifted); }, mechanics);
    state_known = false;
  }

  std::size_t first, robots;  // [first, first + robots) of all
  Mechanics mechanics;
  StateLayout layout;
  std::vector<double> q, u, u_before;
  IntegratorScratch scratch;
  std::vector<WheelTorques> torques;
  bool state_known = false;
};

}  // namespace omnihil
