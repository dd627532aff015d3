// Imbalance of the rotor: gravity on its eccentric mass, or a bent shaft's pull. Once per rotor turn.
#include <cmath>

#include "sim/law/effect_entry.h"
#include "sim/law/fast_sin.h"

namespace omnihil {
namespace {

struct Imbalance {
  enum Param { kTorque, kPhase };
  static constexpr EffectParam kParams[] = {
      {.name = "torque_Nm",
       .unit = "N m",
       .typical = 0.002,  // an outer rotor of 40 g off by 5 mm, or a pinion with a set screw (estimate)
       .lower = -10,
       .upper = 10,
       .prior_scale = 0.005,
       .what = "m g e of the rotor with its shaft horizontal",
       .how = "current or speed at slow turning: amplitude at once per rotor turn"},
      phase_row("rotor angle at zero, from hanging straight down", "as torque_Nm: phase of that line"),
  };
  static constexpr EffectInfo kInfo{
      .id = "imbalance",
      .title = "Rotor imbalance",
      .equation = "tau = -m g e sin(theta + p), theta of the rotor",
      .source = "Den Hartog, Mechanical Vibrations, 4th ed. 1956 (static imbalance)",
      .cannot = "the centrifugal force on the bearings and what it shakes, friction that follows from it",
      .place = Place::kTorque,
      .twins = {"gravity_load", "encoder_eccentricity"},
      .reveals =
          "constant slow speeds both ways: speed ripple once per rotor turn that falls as 1 / speed (that of "
          "an "
          "eccentric encoder grows with speed); current at the same order",
      .visible = "the speed ripple A / (J omega) against the encoder's step, at a creep of 2 rad/s",
      .min_visible =
          [](const SensorSet& s) {
            // A = J omega d_omega, J = 3e-5, omega = 2 rad/s; d_omega: one count per sample, averaged
            const double speed_step_rad_s = 6.283185307179586 / s.counts_per_turn * s.rate_Hz;
            return 3e-5 * 2.0 * speed_step_rad_s / std::sqrt(s.rate_Hz * s.duration_s);
          },
      .claims = kConservative,
      .of_angle = LawOfAngle::kRotor,
      .params = kParams,
      .plot = {.excitation = "turn", .x = "rotor_angle", .y = "load_torque", .from_s = 0.0, .to_s = 4.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    // tau = -m g e sin(theta + p)
    port.tau_Nm -= p[kTorque] * sin_of(port.theta_rotor_rad + p[kPhase]);
  }
};

}  // namespace

OMNIHIL_EFFECT(imbalance, Imbalance)

}  // namespace omnihil
