// Sag of the supply: the bus voltage falls with the current that all drives take together.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct BatterySag {
  enum Param { kResistance };
  static constexpr double kLeastShare = 0.1;  // a supply further down has long switched off
  static constexpr EffectParam kParams[] = {
      {.name = "resistance_ohm",
       .unit = "ohm",
       .typical = 0.04,  // 20 to 60 mohm with cables (estimate)
       .lower = 0,
       .upper = 2,
       .prior_scale = 0.05,
       .what = "resistance of battery, cables and connectors",
       .how = "bus voltage against bus current, one motor and all motors together"},
  };
  static constexpr EffectInfo kInfo{
      .id = "battery_sag",
      .title = "Battery sag",
      .equation = "V = V0 - R_b i_bus, not below V0 / 10",
      .source = "Chen, Rincon-Mora, IEEE Trans. Energy Conversion 21(2), 2006 (its series resistance alone)",
      .cannot =
          "the slow part (seconds) of a battery's response, the fall with its charge, the bus "
          "capacitor; not called where the bus voltage is measured at the bridge",
      .place = Place::kSupply,
      .twins = {"winding_heating", "current_limit"},
      .reveals =
          "hard steps with one motor and with all: bus voltage dips with the bus current at once, on "
          "all wheels; without a logged bus voltage the stall current and free speed shrink together",
      .visible = "the voltage noise over the largest bus current, from one second of steps",
      .min_visible =
          [](const SensorSet& s) {
            // R_b = 3 sigma_V / (i sqrt(n)), i = 10 A for one second
            return 3.0 * s.voltage_sigma_V / (10.0 * std::sqrt(s.rate_Hz));
          },
      .claims = kDissipative | kOdd,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "bus_voltage", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, SupplyPort<T>& port) {
    // V = V0 - R_b i_bus
    const T sagged = port.bus_voltage_V - p[kResistance] * port.bus_current_A;
    const T least = kLeastShare * port.bus_voltage_V;
    port.bus_voltage_V = sagged < least ? least : sagged;
  }
};

}  // namespace

OMNIHIL_EFFECT(battery_sag, BatterySag)

}  // namespace omnihil
