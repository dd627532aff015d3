// Low pass of the measured current: an RC at the amplifier, or a firmware's smoothing of its ADC.
#include "sim/effects/loop_period.h"
#include "sim/law/effect_entry.h"
#include "sim/law/first_order_lag.h"

namespace omnihil {
namespace {

struct CurrentLowPass {
  enum Param { kTimeConstant, kLoopPeriod };
  enum State { kFiltered, kInput, kStarted };
  static constexpr EffectParam kParams[] = {
      {.name = "time_constant_s",
       .unit = "s",
       .typical = 0.005,  // RC of a shunt amplifier 0.02 ms, smoothing in firmware 1 to 50 ms (estimate)
       .lower = 0,
       .upper = 1.0,
       .prior_scale = 0.01,
       .what = "time constant of the low pass between the winding's current and the measured one",
       .how = "steps of the duty with the rotor held: rise of the current against L / R",
       .trait = ParamTrait::kTime},
      kLoopPeriodRow,
  };
  static constexpr EffectState kStates[] = {
      {.name = "filtered_A", .unit = "A"},
      {.name = "input_A", .unit = "A"},  // at the sample before
      {.name = "started", .unit = "1"},
  };
  static constexpr EffectInfo kInfo{
      .id = "current_low_pass",
      .title = "Low pass of the measured current",
      .equation =
          "tau dx/dt = i - x, y = i - (i - x) exp(-P / 2 tau), i the mean over each sample's period, P the "
          "loop's period",
      .source =
          "Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed. 1998 (first order hold)",
      .cannot = "filters of a higher order, what the filter makes of ripple within a PWM period",
      .place = Place::kSensor,
      .twins = {"winding_inductance", "motor.inductance_H"},
      .reveals =
          "steps of the duty beside a speed: the current late and rounded, its peak cut, while the shaft "
          "speeds up as if it had been there",
      .visible = "a lag of a fifth of a sample with steps of full duty",
      .min_visible = [](const SensorSet& s) { return 0.2 / s.rate_Hz; },
      .claims = kOdd,
      .demands = kNeedsMeasuredCurrent,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "motor_current", .from_s = 0.3, .to_s = 0.7},
  };

  template <typename T>
  static void apply(const T* p, T* x, SensorPort<T>& port) {
    // tau dx/dt = i - x
    SampledLag<T> lag{x[kFiltered], x[kInput], x[kStarted]};
    port.measured_current_A =
        lag.reading(port.measured_current_A, port.dt_s, p[kTimeConstant], p[kLoopPeriod]);
  }
};

}  // namespace

OMNIHIL_EFFECT(current_low_pass, CurrentLowPass)

}  // namespace omnihil
