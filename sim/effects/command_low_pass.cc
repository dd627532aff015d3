// Low pass of the command: firmware that smooths what it is asked for.
#include "sim/effects/loop_period.h"
#include "sim/law/effect_entry.h"
#include "sim/law/first_order_lag.h"

namespace omnihil {
namespace {

struct CommandLowPass {
  enum Param { kTimeConstant, kLoopPeriod };
  enum State { kSmoothed, kStarted };
  static constexpr EffectParam kParams[] = {
      {.name = "time_constant_s",
       .unit = "s",
       .typical = 0.008,  // smoothing of commands in hobby and league firmware: 2 to 50 ms (estimate)
       .lower = 0,
       .upper = 1.0,
       .prior_scale = 0.02,
       .what = "time constant of the low pass between asking and doing",
       .how = "steps of the command: time to 63 % of the current or voltage, with the rotor held",
       .trait = ParamTrait::kTime},
      kLoopPeriodRow,
  };
  static constexpr EffectState kStates[] = {
      {.name = "smoothed", .unit = "1"},  // in the command's unit
      {.name = "started", .unit = "1"},   // 0 until the first call, which starts from what was asked before
  };
  static constexpr EffectInfo kInfo{
      .id = "command_low_pass",
      .title = "Low pass of the command",
      .equation = "tau dx/dt = u - x, u' = u - (u - x) exp(-P / 2 tau), P the loop's period",
      .source =
          "Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed. 1998 (zero order hold)",
      .cannot = "filters of a higher order, moving averages, limits of the rate (command_rate_limit)",
      .place = Place::kCommand,
      .twins = {"actuator_delay", "sampling_delay", "command_rate_limit", "winding_inductance",
                "motor.inductance_H"},
      .reveals =
          "chirp or steps of the command: gain that falls with the frequency beside a phase that a pure "
          "delay would give alone",
      .visible = "a fifth of a sample with steps of full duty",
      .min_visible = [](const SensorSet& s) { return 0.2 / s.rate_Hz; },
      .claims = kOdd,
      .numerics = kFine,
      .demands = kNeedsSimulation,
      .excludes = {"controller.latency_s", BaseExclusion::kWherePresent},
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.35, .to_s = 0.6},
  };

  template <typename T>
  static void apply(const T* p, T* x, CommandPort<T>& port) {
    if (value_of(x[kStarted]) == 0.0) {
      x[kStarted] = T(1);
      x[kSmoothed] = port.asked_before();
    }
    // tau dx/dt = u - x, its mean over the sub-step
    const T smoothed = lag_behind_held(x[kSmoothed], port.setpoint, port.dt_s, p[kTimeConstant]);
    port.setpoint = of_a_loop(smoothed, port.setpoint, p[kLoopPeriod], p[kTimeConstant]);
  }
};

}  // namespace

OMNIHIL_EFFECT(command_low_pass, CommandLowPass)

}  // namespace omnihil
