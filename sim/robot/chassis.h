// Mechanics back end on Simbody: all robots in one multibody system, each a chassis and its wheels on pins. Forces and torques
// are ours; Simbody solves M udot = f (articulated bodies).
//
//   Chassis back(robots, Chassis::Joint::kPlanar);   // see mechanics.h for the calls
//
// kPlanar: the chassis slides on the floor's plane; loads by the law of wheel_load.h. The reference that
//   PlanarMechanics is held to.
// kFree: the chassis has all six freedoms (quaternion) and stands on springs and dampers, one under each
//   wheel's middle: N = max(0, k depth + c rate). k lets the robot sink kFloorSink_m under its weight, c is
//   kFloorDamping of critical (floor and tyre together: guess, +-50 %). Wheels can lift, the robot can tip.
//   Roll and pitch inertia are those of a cylinder as high as twice the centre of mass (guess, +-30 %):
//   models give the yaw inertia only.
// Spin inertia: Simbody's pins have no rotor inertia of their own, so wheel_inertia + gear^2 rotor_inertia is the
//   wheel body's axial inertia. A rigid body needs I_x + I_y >= I_z; the wheel's diametral inertia is therefore
//   half the axial one, more than the real wheel's, and the chassis is given that much less yaw inertia: the
//   robot's total is exact. In kFree the rotors' share of the spin also turns with the chassis
//   as gear^2 J instead of gear J, which inflates gyroscopic pitch and roll moments: about 1 % of m a h.
// A locked wheel gets the torque that answers the floor, with its reaction on the chassis, and exactly no
//   acceleration against it. In kFree that leaves out the wheel's own inertia against pitch: J times its rate.
// All robots of one system have the same number of wheels (validate.h).
// Cannot represent: contact between robots, walls, a ball; contact off the wheel's middle. Simbody itself
// allocates per evaluation; nothing here does.
#pragma once
#include <memory>
#include <vector>

#include "sim/robot/floor_effects.h"
#include "sim/robot/mechanics.h"

namespace omnihil {

inline constexpr double kFloorSink_m = 0.5e-3;
inline constexpr double kFloorDamping = 0.5;

class Chassis {
 public:
  enum class Joint { kPlanar, kFree };
  // effects: one per robot, null where a robot has none; kept, not owned. Empty: none at all.
  Chassis(const std::vector<RobotModel>& robots, Joint joint,
          const std::vector<const FloorEffects*>& effects = {});
  ~Chassis();
  Chassis(Chassis&&) noexcept;
  Chassis& operator=(Chassis&&) noexcept;

  const StateLayout& layout() const;
  // Wheels that the floor does not reach, from the next set_state on.
  void lift(std::size_t robot, const PerWheel<bool>& lifted);
  void set_state(const std::vector<double>& q, const std::vector<double>& u);
  const WheelContacts<double>& contacts(std::size_t robot) const;
  const FloorForces& floor_forces(std::size_t robot) const;  // of a robot with effects only
  void accelerations(const std::vector<WheelTorques>& torques, StepPart part, std::vector<double>& udot);
  static constexpr bool kRatesAreSpeeds = false;
  void position_rates(const std::vector<double>& q, const std::vector<double>& u,
                      std::vector<double>& qdot) const;
  void normalise(std::vector<double>& q) const;

  Heading heading(const std::vector<double>& q, std::size_t robot) const;
  BodyMotion motion(const std::vector<double>& q, const std::vector<double>& u, std::size_t robot) const;
  void place(std::vector<double>& q, std::vector<double>& u, std::size_t robot, double x_m, double y_m,
             double yaw_rad) const;

  // Mass matrix of all speeds at the state set last, row by row; and the forces that velocity alone asks
  // for (inverse dynamics at zero acceleration). For checks against the closed form.
  std::vector<double> mass_matrix() const;
  std::vector<double> velocity_forces() const;
  // Height of the geometric centre's wheel-axle plane and the body's tilt against the vertical.
  double height_m(std::size_t robot) const;
  double tilt_rad(std::size_t robot) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil
