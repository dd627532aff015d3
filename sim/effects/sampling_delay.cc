// Measurements that are older than their stamp.
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct SamplingDelay {
  enum Param { kDelay };
  static constexpr EffectParam kParams[] = {
      {.name = "delay_s",
       .unit = "s",
       .typical = 0.003,  // one to a few periods of a servo bus (estimate)
       .lower = 0,
       .upper = 0.1,
       .prior_scale = 0.005,
       .what = "how much older than its stamp a measurement of the drive is",
       .how = "an externally imposed motion with a second sensor of known delay",
       .trait = ParamTrait::kTime},
  };
  static constexpr EffectInfo kInfo{
      .id = "sampling_delay",
      .title = "Sampling delay",
      .equation = "y(t) -> y(t - d) for everything the drive's sensors give",
      .source = "Ljung, System Identification, 2nd ed. 1999 (time delay of the output)",
      .cannot = "differ between channels, vary from sample to sample (sample_jitter)",
      .place = Place::kTiming,
      .twins = {"actuator_delay", "speed_low_pass"},
      .reveals =
          "imposed motion, or steps of an external load: position and speed late by the same time at "
          "every frequency; with the command as the only reference it is the same as actuator_delay",
      .visible = "a tenth of a sample with steps of full duty",
      .min_visible = [](const SensorSet& s) { return 0.1 / s.rate_Hz; },
      .claims = kOdd,
      .numerics = kFine,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 0.6},
  };

  template <typename T>
  static void apply(const T* p, T*, TimingPort<T>& port) {
    // y(t - d)
    if (port.what == Stamped::kDriveSensors) port.age_s += p[kDelay];
  }
};

}  // namespace

OMNIHIL_EFFECT(sampling_delay, SamplingDelay)

}  // namespace omnihil
