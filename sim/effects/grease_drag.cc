// Drag of a lubricant whose shear stress is limited: rises from zero with the speed and stays there. Grease
// in ball screws, bearings and gears.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct GreaseDrag {
  enum Param { kTorque, kSpeed };
  static constexpr EffectParam kParams[] = {
      {.name = "torque_Nm",
       .unit = "N m",
       .typical = 0.002,  // half of the dry friction of a greased ball screw (measured on one)
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.01,
       .what = "drag torque that it tends to at speed",
       .how = "steady current at many low speeds, both ways: rise from breakaway to the straight line that "
              "viscous friction draws"},
      {.name = "speed_rad_s",
       .unit = "rad/s",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 10,  // a tenth of top speed (measured on one ball screw)
       .lower = 0.05,
       .upper = 500,
       .prior_scale = 20,
       .what = "rotor speed at which 63 % of it is there",
       .how = "as torque_Nm: where the curve bends",
       .grid = {GridOf::kTopSpeed, {0.01, 0.04, 0.15}}},
  };
  static constexpr EffectInfo kInfo{
      .id = "grease_drag",
      .title = "Grease drag",
      .equation = "tau = -c_g (1 - exp(-|omega| / omega_g)) sgn(omega)",
      .source = "Bair and Winer, J. Lubrication Technology 101(3), 1979 (limiting shear stress)",
      .cannot =
          "hold a rotor at rest (coulomb_friction), soften with temperature, lag behind the speed; tell a "
          "limited shear stress from other laws that bend alike (Eyring's, a power of the speed)",
      .place = Place::kTorque,
      .twins = {"coulomb_friction", "motor.viscous_friction_Nm_s_per_rad", "lugre_friction"},
      .nests = {"coulomb_friction"},
      .reveals =
          "very slow turning both ways up to top speed: current against speed rises steeply, bends, and "
          "goes on along the line of viscous friction",
      .visible = "three sigma of the mean current of one second at each of two speeds, times the constant",
      .min_visible =
          [](const SensorSet& s) {
            // Difference of two one-second means of the current, at 30 mN m/A, to three sigma; a quarter of
            // it is left where Coulomb and viscous friction have taken their best line.
            return 4.0 * 0.03 * 3.0 * s.current_sigma_A * std::sqrt(2.0 / s.rate_Hz);
          },
      .claims = kDissipative | kOdd,
      .params = kParams,
      .plot = {.excitation = "ramp", .x = "velocity", .y = "motor_current", .from_s = 0.0, .to_s = 4.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    using std::abs;
    using std::exp;
    const T speed = abs(port.omega_rotor_rad_s);
    const T ratio = speed / p[kSpeed];
    // c_g (1 - exp(-r)) / |omega|: a viscous coefficient that falls with speed, solved with the rotor;
    // (1 - exp(-r)) / r = 1 - r / 2 + … where the difference would cancel
    if (value_of(ratio) < 1e-5) return port.add_viscous(p[kTorque] / p[kSpeed] * (1.0 - 0.5 * ratio));
    const T risen = value_of(ratio) > 40.0 ? T(1.0) : T(1.0 - exp(-ratio));  // exp(-40): below rounding
    port.add_viscous(p[kTorque] * risen / speed);
  }
};

}  // namespace

OMNIHIL_EFFECT(grease_drag, GreaseDrag)

}  // namespace omnihil
