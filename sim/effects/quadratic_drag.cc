// Drag with the square of the speed: windage, churning grease, part of the iron loss.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct QuadraticDrag {
  enum Param { kCoefficient };
  static constexpr EffectParam kParams[] = {
      {.name = "coefficient_Nm_s2_per_rad2",
       .unit = "N m s2/rad2",
       .typical = 1e-8,  // 2 mN m at 450 rad/s: +10 to 30 % of the no-load torque at top speed (estimate)
       .lower = 0,
       .upper = 1,
       .prior_scale = 5e-8,
       .what = "drag torque per square of the rotor's speed",
       .how = "no-load current at six speeds or more: its curvature, times the torque constant"},
  };
  static constexpr EffectInfo kInfo{
      .id = "quadratic_drag",
      .title = "Quadratic drag",
      .equation = "tau = -q omega |omega|",
      .source = "Vrancik, NASA TN D-4849, 1968 (windage of rotors: power with the third power of speed)",
      .cannot =
          "a drag that grows less than in proportion to speed, as cold grease does: a fit then ends at zero; "
          "tell windage from eddy currents in the iron",
      .place = Place::kTorque,
      .twins = {"motor.viscous_friction_Nm_s_per_rad"},
      .reveals = "no-load staircase up to top speed: curvature of the current against speed",
      .visible = "three sigma of a second's mean current against the curvature at 400 rad/s",
      .min_visible =
          [](const SensorSet& s) {
            // A parabola q w^2 less its best line over 0 ... W leaves W^2 / 8 q at most; at 30 mN m/A, W =
            // 400
            return 3.0 * 0.03 * s.current_sigma_A / std::sqrt(s.rate_Hz) / (400.0 * 400.0 / 8.0);
          },
      .claims = kDissipative | kOdd,
      .params = kParams,
      .plot = {.excitation = "ramp", .x = "velocity", .y = "motor_current", .from_s = 0.0, .to_s = 4.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    using std::abs;
    // tau = -(q |omega|) omega: a viscous coefficient that grows with speed, solved with the rotor
    port.add_viscous(p[kCoefficient] * abs(port.omega_rotor_rad_s));
  }
};

}  // namespace

OMNIHIL_EFFECT(quadratic_drag, QuadraticDrag)

}  // namespace omnihil
