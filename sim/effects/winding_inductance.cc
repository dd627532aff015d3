// Inductance of the winding beyond what the model has: the current follows the voltage late.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct WindingInductance {
  enum Param { kInductance };
  static constexpr EffectParam kParams[] = {
      {.name = "inductance_H",
       .unit = "H",
       .typical = 5e-4,  // EC 45 flat 0.24 to 0.56 mH, data sheets
       .lower = 0,
       .upper = 0.1,
       .prior_scale = 1e-3,
       .what = "inductance on top of the model's, terminal to terminal",
       .how =
           "locked rotor, chirp of the duty from 100 to 500 Hz: current's gain falls, or time constant of a "
           "step, at 5 kHz or faster",
       .trait = ParamTrait::kTime},
  };
  static constexpr EffectInfo kInfo{
      .id = "winding_inductance",
      .title = "Winding inductance",
      .equation = "L di/dt = u - R i - k omega, L -> L + L_x",
      .source = "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. 2003",
      .cannot = "depend on angle or current; the ripple of the current within a PWM period",
      .place = Place::kWinding,
      .twins = {"actuator_delay", "motor.inductance_H"},
      .reveals =
          "duty chirp 100 to 500 Hz or steps, current at 5 kHz or faster: first-order lag with falling gain "
          "(a delay leaves the gain)",
      .visible = "a time constant of a tenth of a sample with steps of many amperes",
      .min_visible =
          [](const SensorSet& s) {
            // L = R T / 10 for large steps; current noise against a 5 A step, ten steps per second
            const double steps = 10.0 * s.duration_s;
            return 1.2 / s.rate_Hz * (0.1 + 3.0 * s.current_sigma_A / 5.0 / std::sqrt(steps));
          },
      .claims = kOdd,
      .excludes = {"motor.inductance_H", BaseExclusion::kWhereFree},
      .params = kParams,
      .plot = {.excitation = "prbs", .x = "time", .y = "motor_current", .from_s = 0.1, .to_s = 0.2},
  };

  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    port.inductance_H += p[kInductance];
  }
};

}  // namespace

OMNIHIL_EFFECT(winding_inductance, WindingInductance)

}  // namespace omnihil
