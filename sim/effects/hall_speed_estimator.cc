// Speed from Hall pulses: counted over a window, then held until the next window is over.
#include <cmath>
#include <numbers>

#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"
#include "sim/law/first_order_lag.h"

namespace omnihil {
namespace {

struct HallSpeedEstimator {
  enum Param { kPulses, kWindow };
  enum State { kSpeed, kElapsed, kFirstPulse, kStarted, kInput, kStages };
  // The mean of a window w, held for w, at any phase: impulse response a triangle, mean delay w and variance w^2 / 6. As many
  // equal lags in a row have both.
  static constexpr int kLags = 6;  // derived
  static double pulses_of(const DriveParams<double>& drive) {
    return drive.pole_pairs > 0 ? 6.0 * drive.pole_pairs : 48.0;
  }
  static constexpr EffectParam kParams[] = {
      {.name = "pulses_per_turn",
       .unit = "1",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 48,
       .lower = 1,
       .upper = 1000,
       .what = "pulses per rotor turn: six per electrical turn",
       .how = "count them over a turn by hand",
       .start_for = pulses_of,
       .trait = ParamTrait::kCount},
      {.name = "window_s",
       .unit = "s",
       .typical = 0.02,  // 9 to 68 samples of a student drive, 27 ms claimed by its author (measured)
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.02,
       .what = "time over which pulses are counted, and for which the result is held",
       .how = "steps: the measured speed against the slope of the position",
       .trait = ParamTrait::kTime},
  };
  static constexpr EffectState kStates[] = {
      {.name = "speed_rad_s", .unit = "rad/s"},   {.name = "elapsed_s", .unit = "s"},
      {.name = "first_pulse", .unit = "1"},       {.name = "started", .unit = "1"},
      {.name = "input_rad_s", .unit = "rad/s"},  // at the sample before
      {.name = "stage_1_rad_s", .unit = "rad/s"}, {.name = "stage_2_rad_s", .unit = "rad/s"},
      {.name = "stage_3_rad_s", .unit = "rad/s"}, {.name = "stage_4_rad_s", .unit = "rad/s"},
      {.name = "stage_5_rad_s", .unit = "rad/s"},
  };
  static constexpr EffectInfo kInfo{
      .id = "hall_speed_estimator",
      .title = "Speed estimate from Hall pulses",
      .equation =
          "measured = (2 pi / n) (pulses within the window) / window, held for a window; expected: six lags "
          "in a row, (w / 6) x_k' = x_(k-1) - x_k, x_0 = omega",
      .source =
          "Ohmae, Matsuda, Kamiyama, Tachikawa, IEEE Trans. Ind. Electron. 29(3), 1982 (M method: pulses in "
          "a "
          "fixed time); expected value: lags of the same mean delay and variance (ours)",
      .cannot =
          "unequal spacing of the sensors, estimators by time between pulses, ripple of the window's "
          "length; the phase of the windows where a fit asks for expected values",
      .place = Place::kSensor,
      .twins = {"sampling_delay", "speed_low_pass"},
      .nests = {"speed_low_pass"},  // without a sign of the pulses it is no more than that
      .reveals =
          "slow speeds and steps: a staircase of the measured speed of height 2 pi / (n w); late "
          "against the slope of the measured position by w; with no seed of noise the lag alone",
      .visible = "a lag of a fifth of a sample with steps of full duty",
      .min_visible = [](const SensorSet& s) { return 0.2 / s.rate_Hz; },
      .claims = kRandom | kCountsPulses,
      .demands = kNeedsReportedSpeed,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.3, .to_s = 0.7},
  };

  template <typename T>
  static T pulse_number(const T& theta_rad, const T& pulses) {
    return T(std::floor(value_of(theta_rad) * value_of(pulses) / (2.0 * std::numbers::pi)));
  }

  // What such a firmware gives: pulses counted and held.
  template <typename T>
  static void count_pulses(const T* p, T* x, SensorPort<T>& port) {
    x[kElapsed] += port.dt_s;
    if (value_of(x[kElapsed]) >= value_of(p[kWindow]) * (1.0 - 1e-9)) {
      const T pulse = pulse_number(port.theta_rotor_rad, p[kPulses]);
      // (2 pi / n) pulses / time
      x[kSpeed] = 2.0 * std::numbers::pi / p[kPulses] * (pulse - x[kFirstPulse]) / x[kElapsed];
      x[kFirstPulse] = pulse;
      x[kElapsed] = T(0);
    }
  }

  // (w / 6) x_k' = x_(k-1) - x_k, each input on a line within the step
  template <typename T>
  static void expect(const T* p, T* x, const SensorPort<T>& port) {
    const T lag_s = p[kWindow] / double(kLags);
    T from = x[kInput], to = port.measured_speed_rad_s;
    for (int k = 0; k < kLags; ++k) {
      T& stage = k + 1 < kLags ? x[kStages + k] : x[kSpeed];
      const T before = stage;
      stage = lag_behind_line(before, from, to, port.dt_s, lag_s);
      from = before, to = stage;
    }
  }

  template <typename T>
  static void apply(const T* p, T* x, SensorPort<T>& port) {
    if (value_of(x[kStarted]) == 0.0 && port.dt_s <= 0.0) {
      x[kSpeed] = port.measured_speed_rad_s;
      for (int k = 0; k < kLags - 1; ++k) x[kStages + k] = port.measured_speed_rad_s;
      x[kFirstPulse] = pulse_number(port.theta_rotor_rad, p[kPulses]);
    } else if (port.noise != nullptr) {
      count_pulses(p, x, port);
    } else if (port.dt_s > 0.0) {
      expect(p, x, port);
    }
    x[kInput] = port.measured_speed_rad_s;
    x[kStarted] = T(1);
    port.measured_speed_rad_s = x[kSpeed];
  }
};

}  // namespace

OMNIHIL_EFFECT(hall_speed_estimator, HallSpeedEstimator)

}  // namespace omnihil
