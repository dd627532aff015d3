// Friction of a gear that grows with the torque on its teeth.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct LoadDependentFriction {
  enum Param { kDrive, kBackdrive };
  static constexpr EffectParam kParams[] = {
      {.name = "drive_fraction",
       .unit = "1",
       .typical = 0.08,  // 0.02 to 0.05 for one spur stage (estimate), 0.05 to 0.34 in servo gears (measured)
       .lower = 0,
       .upper = 1,
       .prior_scale = 0.1,
       .what = "friction torque per motor torque",
       .how = "the same steady speed under three loads or more: friction over motor torque"},
      {.name = "backdrive_fraction",
       .unit = "1",
       .typical = 0.06,
       .lower = 0,
       .upper = 1,
       .prior_scale = 0.1,
       .what = "friction torque per load torque, both at the rotor; 1: the load cannot drive the motor",
       .how = "the load drives the motor at several loads: friction over load torque"},
  };
  static constexpr EffectInfo kInfo{
      .id = "load_dependent_friction",
      .title = "Load-dependent friction",
      .equation = "level += |K_m tau_motor - K_e tau_load|, tau_load positive where it accelerates",
      .source =
          "Duclusaud, Passault, Padois, Ly, Extended Friction Models for the Physics Simulation of Servo "
          "Actuators, arXiv 2410.08650, 2024 (its load-dependent models)",
      .cannot =
          "tell tooth torque from motor torque: what accelerates the rotor itself counts as load; change "
          "with "
          "speed or temperature",
      .place = Place::kTorque,
      .twins = {"gear_efficiency", "motor.torque_constant_Nm_per_A"},
      .reveals =
          "three loads or accelerations at the same speed, driving and driven: current over load torque. The "
          "loss turns its sign with the direction, an error of the torque constant does not",
      .visible = "three sigma of a second's mean current against a load of 50 mN m",
      .min_visible =
          [](const SensorSet& s) {
            // K = d_tau / tau_motor: two means of one second at 30 mN m/A, 50 mN m
            return 3.0 * 0.03 * s.current_sigma_A * std::sqrt(2.0 / s.rate_Hz) / 0.05;
          },
      .claims = kDissipative | kOdd,
      .numerics = kReadsMotorTorque,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    using std::abs;
    if (value_of(p[kDrive]) == 0.0 && value_of(p[kBackdrive]) == 0.0) {
      // Zero; so written the derivative is that of either fraction alone.
      port.add_friction(p[kDrive] * abs(port.tau_motor_Nm) + p[kBackdrive] * abs(port.tau_load_Nm));
    } else {
      // level += |K_m tau_motor - K_e tau_load|
      port.add_friction(abs(p[kDrive] * port.tau_motor_Nm - p[kBackdrive] * port.tau_load_Nm));
    }
  }
};

}  // namespace

OMNIHIL_EFFECT(load_dependent_friction, LoadDependentFriction)

}  // namespace omnihil
