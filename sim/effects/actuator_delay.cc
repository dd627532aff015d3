// Delay between asking and doing: bus, firmware and PWM update.
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct ActuatorDelay {
  enum Param { kDelay };
  static constexpr EffectParam kParams[] = {
      {.name = "delay_s",
       .unit = "s",
       .typical = 0.005,  // 0.33 ms (EMPS) to 20 ms (servo bus), measured
       .lower = 0,
       .upper = 0.1,
       .prior_scale = 0.01,
       .what = "time from asking to doing",
       .how = "steps or a multisine: phase of the speed that grows in proportion to the frequency at "
              "unchanged gain",
       .trait = ParamTrait::kTime},
  };
  static constexpr EffectInfo kInfo{
      .id = "actuator_delay",
      .title = "Actuator delay",
      .equation = "u(t) -> mean of u over [t - d, t - d + h], h the sub-step",
      .source = "Ljung, System Identification, 2nd ed. 1999 (time delay of the input)",
      .cannot = "vary from packet to packet, drop or reorder commands; delays beyond the last 2048 changes",
      .place = Place::kCommand,
      .twins = {"motor.inductance_H", "winding_inductance", "sampling_delay", "command_low_pass"},
      .reveals = "chirp, PRBS or steps of the duty: speed later by the same time at every frequency",
      .visible = "a tenth of a sample with steps of full duty; a fiftieth with a good chirp",
      .min_visible = [](const SensorSet& s) { return 0.1 / s.rate_Hz; },
      .claims = kOdd,
      .numerics = kDelays,
      .excludes = {"controller.latency_s", BaseExclusion::kWherePresent},
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.35, .to_s = 0.6},
  };

  static_assert(kParams[kDelay].upper * 20e3 < kCommandChanges, "the longest delay, commands at 20 kHz");

  template <typename T>
  static void apply(const T* p, T*, CommandPort<T>& port) {
    // u(t - d), as its mean over the sub-step: piecewise linear in d
    port.setpoint = mean_over(*port.history, port.now_s - p[kDelay], port.dt_s);
  }
};

}  // namespace

OMNIHIL_EFFECT(actuator_delay, ActuatorDelay)

}  // namespace omnihil
