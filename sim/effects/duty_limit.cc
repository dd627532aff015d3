// Limit of the duty: a bridge that is never given its full voltage.
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct DutyLimit {
  enum Param { kCut };
  static constexpr EffectParam kParams[] = {
      {.name = "cut",
       .unit = "1",
       .typical = 0.2,  // firmware value; bootstrap supplies alone need 0.02 to 0.05
       .lower = 0,
       .upper = 0.95,
       .prior_scale = 0.2,
       .what = "what is cut off full duty: the limit is 1 - cut",
       .how = "slow ramp of the duty to full: duty at which the speed stops rising"},
  };
  static constexpr EffectInfo kInfo{
      .id = "duty_limit",
      .title = "Duty limit",
      .equation = "|D| <= 1 - cut",
      .source = "Mohan, Undeland, Robbins, Power Electronics, 3rd ed. 2003 (range of the modulation)",
      .cannot =
          "steps of a coarse PWM timer, over-modulation; a drive asked for a current or torque has no "
          "duty to limit",
      .place = Place::kCommand,
      .twins = {"current_limit"},
      .reveals =
          "ramp of the duty to full, both ways: speed flat above one duty, while the current is far "
          "from flat when loaded",
      .visible =
          "the cut whose loss of speed is three counts of the encoder in a tenth of a second at full duty",
      .min_visible =
          [](const SensorSet& s) {
            // Speed from two counts a tenth of a second apart, of 400 rad/s at full duty.
            return 3.0 * 6.283185307179586 / s.counts_per_turn / (400.0 * 0.1);
          },
      .claims = kOdd | kFlatAtNeutral,
      .demands = kNeedsDuty,
      .params = kParams,
      .plot = {.excitation = "ramp", .x = "duty", .y = "velocity", .from_s = 0.0, .to_s = 8.0},
  };

  template <typename T>
  static void apply(const T* p, T*, CommandPort<T>& port) {
    // |D| <= 1 - cut, with any other limit
    const T limit = 1.0 - p[kCut];
    if (limit < port.duty_limit_ratio) port.duty_limit_ratio = limit;
  }
};

}  // namespace

OMNIHIL_EFFECT(duty_limit, DutyLimit)

}  // namespace omnihil
