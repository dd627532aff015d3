// Back-EMF without the speed in it: not a thing of motors but of models, as in an equation once printed so.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct BackEmfMissing {
  enum Param { kFraction };
  static constexpr EffectParam kParams[] = {
      {.name = "fraction",
       .unit = "1",
       .typical = 0.3,
       .lower = 0,
       .upper = 1,
       .prior_scale = 0.3,
       .what = "share of the back-EMF that does not follow the speed; 1: the equation as printed",
       .how = "duty staircase: no-load speed over voltage against the data sheet's speed constant"},
  };
  static constexpr EffectInfo kInfo{
      .id = "back_emf_missing",
      .title = "Back-EMF without speed",
      .equation = "e = k_e ((1 - f) omega + f (1 rad/s)); f = 1: tau = (k/R) u - k/(R k'), k' = 1 / k_e",
      .source =
          "Bakhshandeh and Sharbafi 2012, eq. 7 as printed; with the speed factor: Hanselman, Brushless "
          "Permanent Magnet Motor Design, 2nd ed. 2003",
      .cannot =
          "be a property of a motor: energy is not kept. A fit that wants it says that a recording or a "
          "model "
          "was made with a wrong equation, or that viscous friction is wrong",
      .place = Place::kWinding,
      .twins = {"motor.viscous_friction_Nm_s_per_rad"},
      .nests = {"constant_load"},  // all of it that the base parameters do not take, and no part of a motor
      .reveals =
          "duty staircase: settled speed at a fixed duty is too high; the slope of current over speed is not "
          "k / R of the data sheet; coasting with open terminals is unchanged",
      .visible = "a current step of three sigma of a second's mean at 300 rad/s through 1.2 ohm",
      .min_visible =
          [](const SensorSet& s) {
            // f = R d_i / (k_e omega): R = 1.2 ohm, k_e omega = 0.0255 * 300 V
            return 3.0 * (1.2 * s.current_sigma_A + s.voltage_sigma_V) / std::sqrt(s.rate_Hz) /
                   (0.0255 * 300.0);
          },
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    constexpr double kPrintedSpeed_rad_s = 1.0;  // what stands where the speed is missing
    // e = k_e ((1 - f) omega + f (1 rad/s))
    port.back_emf_offset_V += p[kFraction] * port.back_emf_V_s_per_rad * kPrintedSpeed_rad_s;
    port.back_emf_V_s_per_rad *= 1.0 - p[kFraction];
  }
};

}  // namespace

OMNIHIL_EFFECT(back_emf_missing, BackEmfMissing)

}  // namespace omnihil
