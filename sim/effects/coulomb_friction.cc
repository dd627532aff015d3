// Dry friction: a level that opposes motion and holds the rotor at rest.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct CoulombFriction {
  enum Param { kTorque };
  static constexpr EffectParam kParams[] = {
      {.name = "torque_Nm",
       .unit = "N m",
       .typical = 0.003,  // MN4004 bare motor 1.5 mN m (measured); EC 45 flat 2 to 6 mN m (estimate)
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.01,
       .what = "friction torque at the rotor, the same at every speed",
       .how = "slow ramp of the current through zero, both ways: half the width of the band in which nothing "
              "moves"},
  };
  static constexpr EffectInfo kInfo{
      .id = "coulomb_friction",
      .title = "Coulomb friction",
      .equation = "tau_friction = -c sgn(omega); at rest the rotor holds while |tau_other| <= c",
      .source = "Coulomb 1785; Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994",
      .cannot =
          "a higher level at low speed (stribeck_friction), elastic creep before sliding (lugre_friction)",
      .place = Place::kTorque,
      .twins = {"dead_time", "pwm_dead_band"},
      .reveals = "slow ramps of the duty through zero: current against speed near zero, both directions",
      .visible = "a tenth of the current noise of one second's mean, times the torque constant",
      .min_visible =
          [](const SensorSet& s) {
            // Mean current over half a second each way, at 30 mN m/A, to three sigma.
            const double samples = s.rate_Hz * 0.5;
            return 0.03 * 3.0 * s.current_sigma_A / (samples > 1 ? std::sqrt(samples) : 1.0);
          },
      .claims = kDissipative | kOdd,
      .in_every_drive = true,
      .params = kParams,
      .plot = {.excitation = "creep", .x = "duty", .y = "velocity", .from_s = 0.0, .to_s = 8.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    // tau_friction = -c sgn(omega); the framework holds the rotor where the levels of all effects suffice
    port.add_friction(p[kTorque]);
  }
};

}  // namespace

OMNIHIL_EFFECT(coulomb_friction, CoulombFriction)

}  // namespace omnihil
