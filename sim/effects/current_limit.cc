// Current limit of the drive: a chopper turns the bridge down as far as the current needs.
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct CurrentLimit {
  enum Param { kInverse };
  static constexpr EffectParam kParams[] = {
      {.name = "inverse_current_per_A",
       .unit = "1/A",
       .typical = 0.2,  // 5 A: firmware value
       .lower = 0,
       .upper = 100,
       .prior_scale = 0.2,
       .what = "one over the largest motor current; 0: no limit",
       .how = "hard steps of the duty: height of the flat top of the motor current"},
  };
  static constexpr EffectInfo kInfo{
      .id = "current_limit",
      .title = "Current limit",
      .equation = "|i| <= 1 / q, q = inverse_current_per_A; the least of all limits holds",
      .source =
          "Mohan, Undeland, Robbins, Power Electronics, 3rd ed. 2003 (current-regulated "
          "bridge); ideal chopper: our simplification",
      .cannot = "foldback over time, a limit of the bus current, overshoot and ripple of a real chopper",
      .place = Place::kBridge,
      .twins = {"saturation", "duty_limit"},
      .reveals =
          "hard steps: motor current flat at one value, often a round number, while the duty is not at "
          "its limit; the speed rises in a straight line",
      .visible = "any limit below the largest current of the record, less its noise",
      .min_visible =
          [](const SensorSet& s) {
            // One over the peak current of a small drive (10 A), from which the noise leaves something.
            return 1.0 / 10.0 * (1.0 + 3.0 * s.current_sigma_A / 10.0);
          },
      .claims = kOdd | kFlatAtNeutral,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "motor_current", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, BridgePort<T>& port) {
    // the least current of all limits: the largest inverse
    if (p[kInverse] > port.inverse_current_limit_per_A) port.inverse_current_limit_per_A = p[kInverse];
  }
};

}  // namespace

OMNIHIL_EFFECT(current_limit, CurrentLimit)

}  // namespace omnihil
