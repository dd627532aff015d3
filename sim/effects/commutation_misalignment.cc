// Commutation misalignment: Hall sensors or the encoder's zero sit beside the place they are taken to have.
#include <cmath>

#include "sim/law/effect_entry.h"
#include "sim/law/fast_sin.h"

namespace omnihil {
namespace {

struct CommutationMisalignment {
  enum Param { kAngle };
  static constexpr EffectParam kParams[] = {
      {.name = "angle_rad",
       .unit = "rad",
       .typical = 0.17,  // 10 degrees electrical: 1.2 degrees of a rotor with 8 pole pairs (estimate)
       .lower = -0.8,
       .upper = 0.8,
       .prior_scale = 0.15,
       .what = "electrical angle by which commutation is early when turning forwards, late backwards",
       .how =
           "torque per ampere under load, or no-load speed, forwards against backwards; with a scope: Hall "
           "edges against the back-EMF's zeros"},
  };
  static constexpr EffectInfo kInfo{
      .id = "commutation_misalignment",
      .title = "Commutation misalignment",
      .equation =
          "k_emf -> k cos(d), k_torque -> k (cos(d) + sin(d) q), q = p L omega |i| / (R |i| + k |omega| + p "
          "L "
          "|omega i|)",
      .source =
          "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. 2003 (cosine); second term "
          "ours: "
          "the current lags its sector by about q, and commutating early makes up for it",
      .cannot =
          "each Hall sensor's own error (a ripple), the current that circulates without load, field "
          "weakening of "
          "a voltage-driven sinusoidal drive. The ratio of torques with and without it is within 0.02 of the "
          "switched six-step drive's, up to 0.2 rad. The second term does not keep the energy balance",
      .place = Place::kWinding,
      .twins = {"motor.torque_constant_Nm_per_A", "friction_asymmetry"},
      .reveals =
          "no load and loaded, both ways: no-load speed up both ways while stall torque per ampere is down; "
          "torque "
          "per ampere under load differs between the directions",
      .visible =
          "the difference of torque per ampere between both directions, one second each at 2 A, q = 0.15",
      .min_visible =
          [](const SensorSet& s) {
            // d_k / k = 2 sin(d) q
            return 3.0 * s.current_sigma_A * std::sqrt(2.0 / s.rate_Hz) / 2.0 / (2.0 * 0.15);
          },
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    using std::abs;
    const T current = abs(port.current_A), speed = abs(port.omega_rotor_rad_s);
    // q = p L omega |i| / (R |i| + k |omega| + p L |omega i|): share of the reactive voltage
    const T reactive_V = double(port.pole_pairs) * port.inductance_H * speed * current;
    const T all_V = port.resistance_ohm * current + port.back_emf_V_s_per_rad * speed + reactive_V;
    T lag = T(0);
    constexpr double kAtRest_V = 1e-9;
    if (value_of(all_V) > kAtRest_V) lag = sign_of(port.omega_rotor_rad_s) * reactive_V / all_V;
    const T cosine = cos_of(p[kAngle]);
    port.torque_constant_Nm_per_A *= cosine + sin_of(p[kAngle]) * lag;
    port.back_emf_V_s_per_rad *= cosine;
  }
};

}  // namespace

OMNIHIL_EFFECT(commutation_misalignment, CommutationMisalignment)

}  // namespace omnihil
