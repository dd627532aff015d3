// Throw-away: a speed from Hall pulses, as a drive's electronics average it over a window.
#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct PulseWindow {
  enum Param { kPulses, kWindow };
  static double pulses_of(const DriveParams<double>& drive) { return 6.0 * drive.pole_pairs; }
  static constexpr EffectParam kParams[] = {
      {.name = "marks_per_turn",
       .unit = "1",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 48,
       .lower = 1,
       .upper = 1000,
       .what = "pulses per rotor turn",
       .how = "count them",
       .start_for = pulses_of,
       .trait = ParamTrait::kCount},
      {.name = "window_s",
       .unit = "s",
       .typical = 0.02,
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.02,
       .what = "time over which pulses are averaged",
       .how = "steps: the measured speed against the slope of the position",
       .trait = ParamTrait::kTime},
  };
  enum State { kSpeed, kStarted };
  static constexpr EffectState kStates[] = {{.name = "speed_rad_s", .unit = "rad/s"},
                                            {.name = "started", .unit = "1"}};
  static constexpr EffectInfo kInfo{
      .id = "pulse_window",
      .title = "Speed over a window of pulses",
      .equation = "w x' = omega - x",
      .source = "a test's own",
      .cannot = "show the steps of the count",
      .place = Place::kSensor,
      .reveals = "steps: a measured speed that is late by w",
      .visible = "a lag of a fifth of a sample",
      .min_visible = [](const SensorSet& s) { return 0.2 / s.rate_Hz; },
      .demands = kNeedsReportedSpeed,
      .params = kParams,
      .states = kStates,
  };

  template <typename T>
  static void apply(const T* p, T* x, SensorPort<T>& port) {
    if (value_of(x[kStarted]) == 0.0 && port.dt_s <= 0.0) {
      x[kSpeed] = port.measured_speed_rad_s;
    } else {
      // w x' = omega - x, implicit
      x[kSpeed] += (port.measured_speed_rad_s - x[kSpeed]) * (port.dt_s / (port.dt_s + p[kWindow]));
    }
    x[kStarted] = T(1);
    port.measured_speed_rad_s = x[kSpeed];
  }
};

}  // namespace

OMNIHIL_EFFECT(pulse_window, PulseWindow)

}  // namespace omnihil
