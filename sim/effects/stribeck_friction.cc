// Stribeck friction: dry friction that is higher at rest and falls as the lubricant begins to carry.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct StribeckFriction {
  enum Param { kExtra, kSpeed, kExponent };
  static constexpr EffectParam kParams[] = {
      {.name = "extra_torque_Nm",
       .unit = "N m",
       .typical = 0.0015,  // 20 to 80 % of the Coulomb level of 1.5 to 6 mN m (estimate)
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.005,
       .what = "friction torque at rest beyond the Coulomb level",
       .how = "breakaway current less the current of slow steady turning, times the torque constant"},
      {.name = "speed_rad_s",
       .unit = "rad/s",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 5,  // 1 to 20 rad/s (estimate)
       .lower = 0.05,
       .upper = 500,
       .prior_scale = 10,
       .what = "rotor speed at which 37 % of it is left",
       .how = "steady current at many low speeds, both ways: where the fall is steepest",
       .grid = {GridOf::kTopSpeed, {0.01, 0.04, 0.15}}},
      {.name = "exponent",
       .unit = "1",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 2,
       .lower = 0.5,
       .upper = 4,
       .prior_scale = 0.5,
       .what = "how sharply it falls; 2: a bell curve",
       .how = "as speed_rad_s: shape of the fall",
       .trait = ParamTrait::kForm},
  };
  static constexpr EffectInfo kInfo{
      .id = "stribeck_friction",
      .title = "Stribeck friction",
      .equation = "level += c_s exp(-|omega / omega_s|^d)",
      .source =
          "Stribeck 1902; Bo and Pavelescu, Wear 82, 1982 (exponent); Armstrong-Helouvry, Dupont, "
          "Canudas de Wit, Automatica 30(7), 1994",
      .cannot =
          "elastic creep before sliding (lugre_friction), a breakaway level that grows with the time at "
          "rest, "
          "a lag of the friction behind the speed",
      .place = Place::kTorque,
      .twins = {"coulomb_friction", "cogging", "lugre_friction"},
      .nests = {"coulomb_friction"},
      .reveals =
          "very slow turning both ways, and starts from rest: current against speed falls from rest to a few "
          "times the speed omega_s; stick-slip under a soft speed controller",
      .visible = "three sigma of the mean current of one second at each of two speeds, times the constant",
      .min_visible =
          [](const SensorSet& s) {
            // Difference of two one-second means of the current, at 30 mN m/A, to three sigma.
            return 0.03 * 3.0 * s.current_sigma_A * std::sqrt(2.0 / s.rate_Hz);
          },
      .claims = kDissipative | kOdd,
      .params = kParams,
      .plot = {.excitation = "creep", .x = "duty", .y = "velocity", .from_s = 0.0, .to_s = 16.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    using std::abs;
    using std::exp;
    using std::pow;
    const T ratio = abs(port.omega_rotor_rad_s) / p[kSpeed];
    if (value_of(ratio) == 0.0) return port.add_friction(p[kExtra]);
    const T power = is_exactly(p[kExponent], 2.0) ? T(ratio * ratio) : T(pow(ratio, p[kExponent]));
    if (value_of(power) > 40.0) return;  // exp(-40) = 4e-18 of it: below rounding
    // level += c_s exp(-|omega / omega_s|^d)
    port.add_friction(p[kExtra] * exp(-power));
  }
};

}  // namespace

OMNIHIL_EFFECT(stribeck_friction, StribeckFriction)

}  // namespace omnihil
