// Magnets lose flux as they warm: less torque per ampere, and more speed per volt.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct MagnetWeakening {
  enum Param { kCoefficient };
  static constexpr EffectParam kParams[] = {
      {.name = "coefficient_per_K",
       .unit = "1/K",
       .typical = 0.0011,  // NdFeB; SmCo 0.0004, ferrite 0.002 (remanence, makers' data)
       .lower = 0,
       .upper = 0.005,
       .prior_scale = 0.001,
       .what = "relative loss of flux per kelvin",
       .how = "no-load speed at the same voltage, cold and hot"},
  };
  static constexpr EffectInfo kInfo{
      .id = "magnet_weakening",
      .title = "Magnet weakening",
      .equation = "k -> k (1 - b T), torque constant and back-EMF constant alike; T: rise of winding_heating",
      .source =
          "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. 2003 (remanence and "
          "temperature)",
      .cannot =
          "a temperature of the magnets of their own (they are taken as warm as the winding, which is too "
          "fast "
          "and too much), loss that stays after cooling",
      .place = Place::kWinding,
      .twins = {"winding_heating"},
      .reveals =
          "no-load speed and stall current cold and hot: the speed rises while the resistance rises too; a "
          "resistance alone leaves the no-load speed",
      .visible = "three counts of the no-load speed over a second, against a rise of 40 K",
      .min_visible =
          [](const SensorSet& s) {
            // b = d_omega / (omega dT): one-second means at 400 rad/s; voltage 12 V
            const double turns_per_s = 400.0 / 6.283185307179586;
            const double speed = 3.0 / (s.counts_per_turn * turns_per_s);
            const double voltage = 3.0 * s.voltage_sigma_V / std::sqrt(s.rate_Hz) / 12.0;
            return (speed + voltage) / 40.0;
          },
      .claims = kOdd,
      .params = kParams,
      .needs = "winding_heating",
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 8.0},
  };

  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    // k -> k (1 - b T)
    const T factor = 1.0 - p[kCoefficient] * port.temperature_rise_K;
    port.torque_constant_Nm_per_A *= factor;
    port.back_emf_V_s_per_rad *= factor;
  }
};

}  // namespace

OMNIHIL_EFFECT(magnet_weakening, MagnetWeakening)

}  // namespace omnihil
