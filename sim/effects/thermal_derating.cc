// Thermal derating: a firmware that allows less current the hotter the winding is.
#include <cmath>

#include "sim/core/effect_entry.h"

namespace omnihil {
namespace {

struct ThermalDerating {
  enum Param { kDrop, kAbove };
  static constexpr double kAmbient_degC = 25.0;  // to which temperature rises refer; data sheets' ambient
  static constexpr double kLeastShare = 0.05;    // of the limit that remains; our choice, so that it exists
  static constexpr EffectParam kParams[] = {
      {.name = "current_drop_A_per_K",
       .unit = "A/K",
       .typical = 0.2,  // firmware value; full current to none within some 20 to 50 K
       .lower = 0,
       .upper = 20,
       .prior_scale = 0.3,
       .what = "fall of the current limit per kelvin above the threshold",
       .how = "long run at the limit: flat top of the current against winding temperature"},
      {.name = "above_degC",
       .unit = "degC",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 80,
       .lower = 0,
       .upper = 200,
       .prior_scale = 20,
       .what = "winding temperature from which the limit falls; ambient is 25 degC",
       .how = "as current_drop_A_per_K"},
  };
  static constexpr EffectInfo kInfo{
      .id = "thermal_derating",
      .title = "Thermal derating",
      .equation =
          "|i| <= i0 - d max(T - T0, 0), not below i0 / 20; i0 the limit without it, or the stall "
          "current V / R where there is none",
      .source = "firmware of common servo drives (a straight line); form: ours",
      .cannot =
          "switch off at once with hysteresis, know a temperature other than the winding's, an ambient "
          "other than 25 degC",
      .place = Place::kBridge,
      .twins = {"winding_heating", "current_limit"},
      .reveals =
          "long hard run: flat top of the current that falls as the winding heats, the duty not at its "
          "limit; recovers after a pause",
      .visible = "three times the current noise of one second's mean, over 20 K above the threshold",
      .min_visible =
          [](const SensorSet& s) {
            const double samples = s.rate_Hz > 1.0 ? s.rate_Hz : 1.0;
            return 3.0 * s.current_sigma_A / 20.0 / std::sqrt(samples);
          },
      .claims = kOdd | kFlatAtNeutral,
      .params = kParams,
      .needs = "winding_heating",
      .plot = {.excitation = "stall", .x = "time", .y = "motor_current", .from_s = 0.0, .to_s = 20.0},
  };

  template <typename T>
  static void apply(const T* p, T*, BridgePort<T>& port) {
    const T excess_K = kAmbient_degC + port.temperature_rise_K - p[kAbove];
    if (value_of(excess_K) <= 0.0) return;
    // 1 / i0
    T inverse = port.inverse_current_limit_per_A;
    if (value_of(inverse) <= 0.0) {
      if (value_of(port.bus_voltage_V) <= 0.0) return;
      inverse = port.resistance_ohm / port.bus_voltage_V;
    }
    // 1 / (i0 - d (T - T0)) = (1/i0) / (1 - d (T - T0) / i0)
    const T share = 1.0 - p[kDrop] * excess_K * inverse;
    const T derated = inverse / (value_of(share) > kLeastShare ? share : T(kLeastShare));
    if (derated > port.inverse_current_limit_per_A && !is_exactly(p[kDrop], 0.0)) {
      port.inverse_current_limit_per_A = derated;
    }
  }
};

}  // namespace

OMNIHIL_EFFECT(thermal_derating, ThermalDerating)

}  // namespace omnihil
