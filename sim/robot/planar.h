// Mechanics back end in closed form: all robots on the plane, 0.1 microseconds per evaluation and robot.
//
//   PlanarMechanics back(robots);   // see mechanics.h for the calls
//
// Laws: planar_law.h (masses), contact.h (floor). No allocation after construction.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

#include "sim/robot/floor_effects.h"
#include "sim/robot/mechanics.h"
#include "sim/robot/planar_law.h"

namespace omnihil {

class PlanarMechanics {
 public:
  // effects: one per robot, null where a robot has none; kept, not owned. Empty: none at all.
  explicit PlanarMechanics(const std::vector<RobotModel>& robots,
                           const std::vector<const FloorEffects*>& effects = {});

  const StateLayout& layout() const { return layout_; }
  // Wheels that the floor does not reach, from the next set_state on.
  void lift(std::size_t robot, const PerWheel<bool>& lifted) { robots_[robot].lifted = lifted; }
  void set_state(const std::vector<double>& q, const std::vector<double>& u);
  const WheelContacts<double>& contacts(std::size_t robot) const { return robots_[robot].contacts; }
  // Of a robot with effects only.
  const FloorForces& floor_forces(std::size_t robot) const { return robots_[robot].more; }
  void accelerations(const std::vector<WheelTorques>& torques, StepPart part, std::vector<double>& udot);
  static constexpr bool kRatesAreSpeeds = true;  // position_rates() gives u
  void position_rates(const std::vector<double>& q, const std::vector<double>& u,
                      std::vector<double>& qdot) const;
  void normalise(std::vector<double>&) const {}

  const Heading& heading(const std::vector<double>& q, std::size_t robot);
  BodyMotion motion(const std::vector<double>& q, const std::vector<double>& u, std::size_t robot) const;
  // At rest at a pose, wheel angles zero.
  void place(std::vector<double>& q, std::vector<double>& u, std::size_t robot, double x_m, double y_m,
             double yaw_rad) const;

 private:
  struct Robot {
    ContactLaw<double> law;
    PlanarBody<double> body;
    double gear_ratio = 1.0;
    double wheel_viscous_Nm_s_per_rad = 0.0;  // rotor friction seen at the wheel: gear^2 b
    double yaw_rad = 0.0;                     // that it was last looked at with
    Heading heading;                          // of that yaw
    double omega_body_rad_s = 0.0;
    WheelContacts<double> contacts;
    const FloorEffects* effects = nullptr;
    FloorForces more;
    PerWheel<bool> lifted{};
  };
  static const Heading& look_along(Robot& r, double yaw_rad);
  static PerWheel<double> wheels_of(const Robot& r, const double* first);
  static bool is_looked_at(const Robot& r, double yaw_rad) {  // its sine and cosine are known
    return std::bit_cast<std::uint64_t>(yaw_rad) == std::bit_cast<std::uint64_t>(r.yaw_rad);
  }

  StateLayout layout_;
  std::vector<Robot> robots_;
  std::vector<double> u_;  // current state
};

}  // namespace omnihil
