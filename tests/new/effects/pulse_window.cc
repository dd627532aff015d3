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
  static constexpr EffectState kStates[] = {{.name = "speed_rad_s", .unit = "rad/s"}};
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
    // w x' = omega - x, implicit
    x[0] += (port.measured_speed_rad_s - x[0]) * (port.dt_s / (port.dt_s + p[kWindow]));
    port.measured_speed_rad_s = x[0];
  }
};

}  // namespace

OMNIHIL_EFFECT(pulse_window, PulseWindow)

}  // namespace omnihil
