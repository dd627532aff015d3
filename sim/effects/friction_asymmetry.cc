// Friction that differs by direction: bearings under axial load, gears ground on one flank, seals, brushes.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct FrictionAsymmetry {
  enum Param { kCoulomb, kViscous };
  static constexpr EffectParam kParams[] = {
      {.name = "coulomb_ratio",
       .unit = "1",
       .typical = 0.2,  // estimate
       .lower = -1,
       .upper = 1,
       .prior_scale = 0.2,
       .what = "dry friction: positive minus negative direction, over their sum",
       .how = "steady current at one speed each way: difference of the intercepts over their sum"},
      {.name = "viscous_ratio",
       .unit = "1",
       .typical = 0.18,  // EMPS: negative over positive 1.44 (measured), so |0.44 / 2.44|
       .lower = -1,
       .upper = 1,
       .prior_scale = 0.2,
       .what = "viscous friction: positive minus negative direction, over their sum",
       .how = "steady current at many speeds each way: difference of the slopes over their sum",
       .trait = ParamTrait::kDamping},
  };
  static constexpr EffectInfo kInfo{
      .id = "friction_asymmetry",
      .title = "Friction asymmetry",
      .equation = "c+ = c (1 + r_c), c- = c (1 - r_c); b+ = b (1 + r_b), b- = b (1 - r_b)",
      .source = "Armstrong-Helouvry, Control of Machines with Friction, 1991 (direction dependence)",
      .cannot =
          "act without friction: it parts what the motor and coulomb_friction have, not Stribeck, LuGre and "
          "load-dependent parts",
      .place = Place::kTorque,
      .twins = {"constant_load"},
      .reveals =
          "symmetric sweep of the speed: current against speed, both ways. The dry part is a constant load's "
          "double (turn the mounting over), the viscous part grows with speed",
      .visible = "three sigma of a second's mean current each way, against a friction of 3 mN m",
      .min_visible =
          [](const SensorSet& s) {
            // r = d_tau / (2 c): means of one second each way at 30 mN m/A, c = 3 mN m
            return 3.0 * 0.03 * s.current_sigma_A * std::sqrt(2.0 / s.rate_Hz) / (2.0 * 0.003);
          },
      .claims = kDissipative,
      .params = kParams,
      .plot = {.excitation = "ramp", .x = "velocity", .y = "motor_current", .from_s = 0.0, .to_s = 4.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    // c+ = c (1 + r_c), c- = c (1 - r_c)
    port.friction_positive_Nm *= 1.0 + p[kCoulomb];
    port.friction_negative_Nm *= 1.0 - p[kCoulomb];
    // b+ = b (1 + r_b), b- = b (1 - r_b)
    port.viscous_positive_Nm_s_per_rad *= 1.0 + p[kViscous];
    port.viscous_negative_Nm_s_per_rad *= 1.0 - p[kViscous];
  }
};

}  // namespace

OMNIHIL_EFFECT(friction_asymmetry, FrictionAsymmetry)

}  // namespace omnihil
