// Magnetic saturation: at high currents the iron carries no more flux, and an ampere gives less torque.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct Saturation {
  enum Param { kInverseCurrent };
  static constexpr EffectParam kParams[] = {
      {.name = "inverse_current_per_A",
       .unit = "1/A",
       .typical = 0.03,  // -4 % at 7 A; 0.4 %/A in a geared actuator, under 5 % below 15 A in SSL motors
       .lower = 0,
       .upper = 1,
       .prior_scale = 0.03,
       .what = "1 over the current at which the torque constant has halved",
       .how = "acceleration per ampere at three currents, or stall torque against current"},
  };
  static constexpr EffectInfo kInfo{
      .id = "saturation",
      .title = "Magnetic saturation",
      .equation = "k -> k / (1 + (i / i_s)^2), torque constant and back-EMF constant alike",
      .source =
          "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. 2003; the form is ours: even, "
          "smooth, k i has its greatest value at i_s",
      .cannot =
          "inductance that falls with current, saturation without current, torque beyond i_s (it falls again "
          "there: stay below)",
      .place = Place::kWinding,
      .twins = {"load_dependent_friction", "current_limit", "wheel_slip"},
      .reveals =
          "accelerations at three current levels, the highest near stall: acceleration per ampere falls with "
          "the square of the current",
      .visible =
          "where a three sigma change of the constant from one second at 8 A is exceeded: grows with the "
          "square root of the noise",
      .min_visible =
          [](const SensorSet& s) {
            // (i / i_s)^2 = d_k / k; d_k / k from the current's mean over a tenth of a second, at 8 A
            return std::sqrt(3.0 * s.current_sigma_A / (8.0 * std::sqrt(0.1 * s.rate_Hz))) / 8.0;
          },
      .claims = kOdd | kFlatAtNeutral,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    // k -> k / (1 + (i / i_s)^2)
    const T ratio = port.current_A * p[kInverseCurrent];
    const T factor = 1.0 / (1.0 + ratio * ratio);
    port.torque_constant_Nm_per_A *= factor;
    port.back_emf_V_s_per_rad *= factor;  // the same flux: otherwise energy would be made when braking
  }
};

}  // namespace

OMNIHIL_EFFECT(saturation, Saturation)

}  // namespace omnihil
