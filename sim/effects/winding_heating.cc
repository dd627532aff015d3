// Heating of the winding: copper loss warms it, its resistance rises; with or without a housing behind it.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct WindingHeating {
  enum Param { kCoefficient, kResistance, kCapacity, kHousingResistance, kHousingCapacity };
  enum State { kWinding, kHousing };
  static constexpr EffectParam kParams[] = {
      {.name = "temperature_coefficient_per_K",
       .unit = "1/K",
       .typical = 0.00393,  // copper at 20 degC, IEC 60028:1925
       .lower = 0,
       .upper = 0.02,
       .prior_scale = 0.004,
       .what = "relative rise of the resistance per kelvin",
       .how = "0.00393 for copper; resistance cold, and after a hold of minutes with the temperature known"},
      {.name = "thermal_resistance_K_per_W",
       .unit = "K/W",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 3.96,  // EC 45 flat 30 W, data sheet
       .lower = 0.01,
       .upper = 200,
       .prior_scale = 5,
       .what = "from winding to housing; to ambient where no housing is given",
       .how = "settled rise of the winding over its loss"},
      {.name = "thermal_capacity_J_per_K",
       .unit = "J/K",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 2.9,  // thermal time constant 11.5 s of the winding over 3.96 K/W, data sheet
       .lower = 0.01,
       .upper = 1e4,
       .prior_scale = 5,
       .what = "of the winding",
       .how = "loss over the rate of rise at the start of a hold",
       .grid = {GridOf::kStartInTime, {1.0, 4.0, 16.0}}},
      {.name = "housing_thermal_resistance_K_per_W",
       .unit = "K/W",
       .role = ParamRole::kDetail,
       .typical = 5.7,  // EC 45 flat 30 W, data sheet
       .lower = 0,
       .upper = 200,
       .prior_scale = 5,
       .what = "from housing to ambient; 0: the housing stays at ambient temperature",
       .how = "settled rise of the housing over the loss"},
      {.name = "housing_thermal_capacity_J_per_K",
       .unit = "J/K",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 44,  // thermal time constant 251 s of the motor over 5.7 K/W, data sheet
       .lower = 0.01,
       .upper = 1e5,
       .prior_scale = 50,
       .what = "of the housing",
       .how = "time constant of the slow part of the rise over its thermal resistance",
       .grid = {GridOf::kStartInTime, {1.0, 4.0, 16.0}}},
  };
  static constexpr EffectState kStates[] = {
      {.name = "winding_rise", .unit = "K"},
      {.name = "housing_rise", .unit = "K"},
  };
  static constexpr EffectInfo kInfo{
      .id = "winding_heating",
      .title = "Winding heating",
      .equation =
          "R -> R (1 + a T_w); C_w dT_w/dt = R i^2 - (T_w - T_h) / R_w; C_h dT_h/dt = (T_w - T_h) / R_w - "
          "T_h / "
          "R_h; rises over ambient, R at ambient",
      .source = "Braun, Formulae Handbook, maxon academy (two-mass thermal model); IEC 60028:1925 (copper)",
      .cannot =
          "heat from iron loss, friction and the bridge; cooling that grows with speed; a start other than "
          "at "
          "ambient temperature",
      .place = Place::kWinding,
      .twins = {"battery_sag", "magnet_weakening"},
      .reveals =
          "a hold against a stop, or the same motion repeated for five minutes: voltage over current at a "
          "fixed "
          "speed rises with time, and falls back when it rests",
      .visible = "three sigma of a second's mean resistance against a rise of 40 K at 2 A",
      .min_visible =
          [](const SensorSet& s) {
            // a = d_R / (R dT): d_R from voltage and current means of one second, 2 A, 1.2 ohm, 40 K
            const double d_R_ohm =
                3.0 * (s.voltage_sigma_V + 1.2 * s.current_sigma_A) / 2.0 / std::sqrt(s.rate_Hz);
            return d_R_ohm / (1.2 * 40.0);
          },
      .claims = kDissipative | kOdd | kWarmsWinding,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "winding_rise", .from_s = 0.0, .to_s = 8.0},
  };

  // Implicit Euler: first order, error h / (2 R C) of a transient, 2e-6 here; settled values are exact.
  template <typename T>
  static void apply(const T* p, T* x, WindingPort<T>& port) {
    const double h = port.dt_s;
    // (C_w / h + 1 / R_w) T_w' = C_w / h T_w + P + T_h / R_w
    // The quotient apart from what waits for the heat: the winding's sub-step waits for all of this.
    const T per_step = h / p[kCapacity];
    const T inverse = 1.0 / (p[kResistance] + per_step);
    const T kept = p[kResistance] * inverse, from_housing = per_step * inverse;
    x[kWinding] = kept * (x[kWinding] + per_step * port.heat_W) + from_housing * x[kHousing];
    if (!is_exactly(p[kHousingResistance], 0.0)) {
      // (C_h / h + 1 / R_w + 1 / R_h) T_h' = C_h / h T_h + T_w / R_w, multiplied by R_h R_w
      const T stored = p[kResistance] * p[kHousingCapacity] / h;
      x[kHousing] = p[kHousingResistance] * (stored * x[kHousing] + x[kWinding]) /
                    (p[kHousingResistance] * (stored + 1.0) + p[kResistance]);
    }
    port.temperature_rise_K = x[kWinding];
    // R -> R (1 + a T_w)
    port.resistance_ohm *= 1.0 + p[kCoefficient] * x[kWinding];
  }
};

}  // namespace

OMNIHIL_EFFECT(winding_heating, WindingHeating)

}  // namespace omnihil
