// Dead time and device drops of the bridge: a voltage that is lost against the current.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct DeadTime {
  enum Param { kVoltage, kWidth };
  static constexpr EffectParam kParams[] = {
      {.name = "voltage_V",
       .unit = "V",
       .typical = 0.4,  // 22 V bus x 0.5 us x 40 kHz (estimate)
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.5,
       .what = "voltage lost at currents well above the width: bus voltage x dead time x PWM frequency, and "
               "drops",
       .how =
           "staircase of small duties at a locked rotor, both ways: offset of the voltage over current line"},
      {.name = "current_width_A",
       .unit = "A",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 0.2,  // about the ripple current; estimate
       .lower = 0.001,
       .upper = 10,
       .prior_scale = 0.3,
       .what = "current at which 71 % of it is there: half the ripple current within a PWM period",
       .how = "as voltage_V: curvature of the line near zero current",
       .trait = ParamTrait::kSmoothing,
       .grid = {GridOf::kTopCurrent, {0.02, 0.1}}},
  };
  static constexpr EffectInfo kInfo{
      .id = "dead_time",
      .title = "Dead time and device drop",
      .equation = "u -= V_d i / sqrt(i^2 + i_w^2)",
      .source =
          "Murai, Watanabe, Iwasaki, IEEE Trans. Ind. Appl., 1987 (mean loss V_bus t_d f_pwm against "
          "the current); root: our smoothing over the ripple current",
      .cannot =
          "the distortion within an electrical turn (sixth order), change with bus voltage or PWM frequency",
      .place = Place::kBridge,
      .twins = {"coulomb_friction", "motor.resistance_ohm"},
      .reveals =
          "locked or slow rotor, small duties both ways: duty x bus - R i - k omega against the current's "
          "sign",
      .visible = "three times the voltage noise of one second's mean",
      .min_visible =
          [](const SensorSet& s) {
            return 3.0 * (s.voltage_sigma_V + 0.5 * s.current_sigma_A) / std::sqrt(s.rate_Hz);
          },
      .claims = kDissipative | kOdd,
      .numerics = kReadsCurrent,
      .params = kParams,
      .plot = {.excitation = "locked", .x = "duty", .y = "motor_current", .from_s = 0.0, .to_s = 16.0},
  };

  template <typename T>
  static void apply(const T* p, T*, BridgePort<T>& port) {
    using std::sqrt;
    // u -= V_d i / sqrt(i^2 + i_w^2)
    const T& i = port.current_A;
    port.voltage_V -= p[kVoltage] * i / sqrt(i * i + p[kWidth] * p[kWidth]);
  }
};

}  // namespace

OMNIHIL_EFFECT(dead_time, DeadTime)

}  // namespace omnihil
