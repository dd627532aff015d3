// Low pass of the reported speed: a tachometer's filter, a firmware's smoothing, an observer's bandwidth.
#include "sim/effects/loop_period.h"
#include "sim/law/effect_entry.h"
#include "sim/law/first_order_lag.h"

namespace omnihil {
namespace {

struct SpeedLowPass {
  enum Param { kTimeConstant, kLoopPeriod };
  enum State { kFiltered, kInput, kStarted };
  static constexpr EffectParam kParams[] = {
      {.name = "time_constant_s",
       .unit = "s",
       .typical = 0.01,  // smoothing of counted speeds in hobby and league firmware: 2 to 50 ms (estimate)
       .lower = 0,
       .upper = 1.0,
       .prior_scale = 0.02,
       .what = "time constant of the low pass between the shaft's speed and the reported one",
       .how = "steps: the reported speed against the slope of a position",
       .trait = ParamTrait::kTime},
      kLoopPeriodRow,
  };
  static constexpr EffectState kStates[] = {
      {.name = "filtered_rad_s", .unit = "rad/s"},
      {.name = "input_rad_s", .unit = "rad/s"},  // at the sample before
      {.name = "started", .unit = "1"},
  };
  static constexpr EffectInfo kInfo{
      .id = "speed_low_pass",
      .title = "Low pass of the reported speed",
      .equation = "tau dx/dt = omega - x, y = omega - (omega - x) exp(-P / 2 tau), P the loop's period",
      .source =
          "Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed. 1998 (first order hold)",
      .cannot = "filters of a higher order, observers that know the torque; the angle is left as it is",
      .place = Place::kSensor,
      .twins = {"sampling_delay", "hall_speed_estimator", "hall_speed_period", "load.inertia_kg_m2"},
      .reveals =
          "steps of the duty beside a position or a current: the reported speed late, and rounded, against "
          "both",
      .visible = "a lag of a fifth of a sample with steps of full duty",
      .min_visible = [](const SensorSet& s) { return 0.2 / s.rate_Hz; },
      .claims = kOdd,
      .demands = kNeedsReportedSpeed,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.3, .to_s = 0.7},
  };

  template <typename T>
  static void apply(const T* p, T* x, SensorPort<T>& port) {
    // tau dx/dt = omega - x
    SampledLag<T> lag{x[kFiltered], x[kInput], x[kStarted]};
    port.measured_speed_rad_s =
        lag.reading(port.measured_speed_rad_s, port.dt_s, p[kTimeConstant], p[kLoopPeriod]);
  }
};

}  // namespace

OMNIHIL_EFFECT(speed_low_pass, SpeedLowPass)

}  // namespace omnihil
