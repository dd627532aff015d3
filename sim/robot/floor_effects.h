// Effects between one robot and the floor, and on its body: asked anew at every state that a back end looks
// at, by both back ends alike.
//
//   FloorEffects effects(set, model, step_s);                // the model that body effects have made
//   FloorForces more;
//   WheelContacts<double> c = effects.contacts(law, motion, state, nullptr, more);
//   more.wheel_radius_m[i], more.friction_wheel_Nm[i], more.body_force_x_N;
//
// Law: the floor's law is that of contact.h with
//     radius            as the effects have it, wheel by wheel: rim speed and lever of the force
//     slip              (v - R omega) / (scale + v_c / extremum slip), v_c the sliding speed that effects add
//     peak              the smaller of the tyre's and the effects' grip; the asymptote goes with it
//     added forces      of effects, with a share in the load transfer
//   Effects are asked twice: with the loads at rest, and with the loads that follow. In the free body the
//   springs know the loads, and once is enough.
// Cannot represent: floor and body effects with a memory; masses and centres of mass that change with time
// (their effects are asked once, before the start: robot_with_effects).
// Plain C++17: the multibody back end includes it.
#pragma once
#include <memory>

#include "sim/robot/contact.h"

namespace omnihil {

template <typename T>
class EffectSet;

struct FloorState {
  double yaw_rad = 0.0;
  BodyVelocity<double> velocity;
  PerWheel<double> omega_wheel_rad_s{};
  PerWheel<double> theta_wheel_rad{};
};

// What comes besides the forces of WheelContacts.
struct FloorForces {
  PerWheel<double> wheel_radius_m{};
  PerWheel<double> friction_wheel_Nm{};  // level that opposes rolling; the drive takes it
  double body_force_x_N = 0.0, body_force_y_N = 0.0, body_moment_z_Nm = 0.0;  // at the geometric centre
};

// The model with what body effects make of mass, yaw inertia and centre of mass.
RobotModel robot_with_effects(const RobotModel& model, const EffectSet<double>& effects);

class FloorEffects {
 public:
  FloorEffects(std::shared_ptr<const EffectSet<double>> effects, const RobotModel& model, double step_s);

  // load_N: known loads, or null for those of wheel_load.h.
  WheelContacts<double> contacts(const ContactLaw<double>& law, const WheelMotion<double>& motion,
                                 const FloorState& state, const PerWheel<double>* load_N,
                                 FloorForces& more) const;

  double dribbler_rad_s = 0.0;  // held over a mechanical step

 private:
  struct Wheel;
  Wheel ask(std::size_t wheel, const WheelMotion<double>& motion, const FloorState& state,
            double load_N) const;
  void ask_body(const FloorState& state, FloorForces& more) const;

  std::shared_ptr<const EffectSet<double>> effects_;
  double wheel_radius_m_ = 0.0;
  double mass_kg_ = 0.0, yaw_inertia_kg_m2_ = 0.0, com_x_m_ = 0.0, com_y_m_ = 0.0;
  double step_s_ = 0.0;
};

}  // namespace omnihil
