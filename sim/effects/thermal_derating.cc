// Thermal derating: a firmware that allows less current the hotter the winding is.
#include <cmath>

#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct ThermalDerating {
  enum Param { kDrop, kAbove, kFull };
  static constexpr double kAmbient_degC = 25.0;   // to which temperature rises refer; data sheets' ambient
  static constexpr double kFullTypical_A = 20.0;  // peak current of a 50 W drive; estimate
  // The largest current that a drive draws from rest: firmware that limits it has its limit about there or
  // below.
  static double stall_current_of(const DriveParams<double>& drive) {
    const bool known = drive.resistance_ohm > 0.0 && drive.supply_voltage_V > 0.0;
    return known ? drive.supply_voltage_V / drive.resistance_ohm : kFullTypical_A;
  }
  static constexpr double kLeastShare = 0.05;   // of the limit that remains; our choice, so that it exists
  static constexpr double kFallsOver_K = 50.0;  // full current to none: estimate, of 20 to 50 K and more
  static double drop_of(const DriveParams<double>& drive) { return stall_current_of(drive) / kFallsOver_K; }

  static constexpr EffectParam kParams[] = {
      {.name = "current_drop_A_per_K",
       .unit = "A/K",
       .typical = kFullTypical_A / kFallsOver_K,
       .lower = 0,
       .upper = 20,
       .prior_scale = 0.3,
       .what = "fall of the current limit per kelvin above the threshold",
       .how = "long run at the limit: flat top of the current against winding temperature",
       .start_for = drop_of},
      {.name = "above_degC",
       .unit = "degC",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 80,
       .lower = 0,
       .upper = 200,
       .prior_scale = 20,
       .what = "winding temperature from which the limit falls; ambient is 25 degC",
       .how = "as current_drop_A_per_K",
       // ever wider above an ambient of 20 to 30 degC (a choice)
       .grid = {GridOf::kAbsolute, {35.0, 40.0, 47.0, 58.0, 75.0}}},
      {.name = "full_current_A",
       .unit = "A",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = kFullTypical_A,
       .lower = 0.1,
       .upper = 300,
       .prior_scale = 10,
       .what = "limit at the threshold; starts at the stall current V / R of the model file",
       .how = "flat top of the current just above the threshold",
       .start_for = stall_current_of},
  };
  static constexpr EffectInfo kInfo{
      .id = "thermal_derating",
      .title = "Thermal derating",
      .equation = "|i| <= i0 - d (T - T0) where T > T0, not below i0 / 20; i0 the full current",
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
      .demands = kNeedsVoltage,
      .params = kParams,
      .needs = "winding_heating",
      .plot = {.excitation = "stall", .x = "time", .y = "motor_current", .from_s = 0.0, .to_s = 20.0},
  };

  template <typename T>
  static void apply(const T* p, T*, BridgePort<T>& port) {
    const T excess_K = kAmbient_degC + port.temperature_rise_K - p[kAbove];
    if (value_of(excess_K) <= 0.0) return;
    // 1 / (i0 - d (T - T0)) = (1/i0) / (1 - d (T - T0) / i0)
    const T inverse = 1.0 / p[kFull];
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
