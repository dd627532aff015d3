// Backlash: play between rotor and output, in which no torque passes.
#include "sim/core/effect_entry.h"

namespace omnihil {
namespace {

struct Backlash {
  enum Param { kGap };
  static constexpr EffectParam kParams[] = {
      {.name = "gap_rad",
       .unit = "rad",
       .typical = 0.005,  // spur gear 3:1 0.1 to 0.3 deg (estimate); small servo 1 deg (measured)
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.01,
       .what = "whole play at the output, from contact to contact",
       .how = "hold the rotor, move the output by hand against a dial; or two encoders at small reversals"},
  };
  static constexpr EffectInfo kInfo{
      .id = "backlash",
      .title = "Backlash",
      .equation = "tau_shaft = 0 while |theta_rotor / N - theta_out| <= gap / 2; beyond, in contact",
      .source = "Nordin, Gutman, Automatica 38(10), 2002 (dead zone model)",
      .cannot = "friction of the flanks within the play, oil film, a gap that differs around the turn",
      .place = Place::kShaft,
      .twins = {"shaft_compliance", "actuator_delay"},
      .reveals =
          "small slow reversals with encoders on rotor and output: hysteresis of width gap; with one "
          "encoder a pause of the output after each reversal, the longer the slower; on a robot the encoders "
          "against the camera, turning to and fro",
      .visible = "two counts of an encoder on the output",
      .min_visible = [](const SensorSet& s) { return 2.0 * 6.283185307179586 / s.counts_per_turn; },
      .claims = kOdd,
      .params = kParams,
      .plot = {.excitation = "creep", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 16.0},
  };

  template <typename T>
  static void apply(const T* p, T*, ShaftPort<T>& port) {
    // plays in a row add up
    port.gap_rad += p[kGap];
  }
};

}  // namespace

OMNIHIL_EFFECT(backlash, Backlash)

}  // namespace omnihil
