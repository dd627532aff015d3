// Speed by the time between Hall pulses: worked out once per electrical turn, held until the next.
#include <algorithm>
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct HallSpeedPeriod {
  enum Param { kAngle, kClockError };
  enum State { kSpeed, kBoundary, kSinceBoundary, kStarted };
  static constexpr EffectParam kParams[] = {
      {.name = "angle_rad",
       .unit = "rad",
       .typical = 1.26,  // one electrical turn of five pole pairs
       .lower = 0,
       .upper = 12.6,  // two mechanical turns
       .prior_scale = 1.26,
       .what = "rotor angle between two results: the time it took gives the speed, held until the next",
       .how = "constant slow speed: the angle turned between two changes of the reported speed"},
      {.name = "clock_error",
       .unit = "1",
       .typical = 0.02,  // a student drive's report against its own pulses: 2 to 4 % (measured)
       .lower = -0.2,
       .upper = 0.2,
       .prior_scale = 0.03,
       .what = "share by which the clock that times the pulses makes the reported speed too large",
       .how = "constant speed: the reported speed against pulses counted over a second"},
  };
  static constexpr EffectState kStates[] = {
      {.name = "speed_rad_s", .unit = "rad/s"},
      {.name = "boundary", .unit = "1"},
      {.name = "since_boundary_s", .unit = "s"},
      {.name = "started", .unit = "1"},
  };
  static constexpr EffectInfo kInfo{
      .id = "hall_speed_period",
      .title = "Speed from the time between Hall pulses",
      .equation =
          "measured = (1 + e) A / (time the last A took), held for the next A; expected: x' = (omega - x) "
          "|omega| / A, "
          "measured = (1 + e) x",
      .source =
          "Ohmae, Matsuda, Kamiyama, Tachikawa, IEEE Trans. Ind. Electron. 29(3), 1982 (T method: time of a "
          "fixed "
          "number of pulses); expected value: first-order lag in the angle, late by A / omega on a ramp "
          "(ours)",
      .cannot =
          "time out to zero at standstill, turn round within an angle, unequal spacing of the sensors; the "
          "lag's shape "
          "where a fit asks for expected values (its mean delay is right: half the angle to measure, half "
          "held)",
      .place = Place::kSensor,
      .twins = {"speed_low_pass", "hall_speed_estimator", "sampling_delay"},
      .reveals =
          "slow speeds and coasting to rest: late by A / omega, so the slower the later, and frozen at "
          "standstill",
      .visible = "a fifth of a sample late at a tenth of full speed",
      .claims = kRandom | kOdd,
      .demands = kNeedsReportedSpeed,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.3, .to_s = 0.7},
  };

  // What such a firmware gives: the time of the last whole angle, both ends taken where the angle passed them.
  template <typename T>
  static void time_the_angle(const T* p, T* x, SensorPort<T>& port) {
    const double angle_rad = value_of(p[kAngle]);
    if (angle_rad <= 0.0 || port.dt_s <= 0.0) {
      if (angle_rad <= 0.0) x[kSpeed] = port.measured_speed_rad_s;
      return;
    }
    const double now = value_of(port.theta_rotor_rad) / angle_rad;
    const double boundary = std::floor(now);
    const double passed = boundary - value_of(x[kBoundary]);
    x[kSinceBoundary] += port.dt_s;
    if (passed == 0.0) return;
    // How long ago the last boundary on the way was passed, at the speed of this sample.
    const double omega_rad_s = value_of(port.omega_rotor_rad_s);
    const double past_rad = angle_rad * (passed > 0.0 ? now - boundary : boundary + 1.0 - now);
    const double ago_s = omega_rad_s == 0.0 ? 0.0 : std::min(past_rad / std::abs(omega_rad_s), port.dt_s);
    // speed = A passed / time
    x[kSpeed] = p[kAngle] * passed / (value_of(x[kSinceBoundary]) - ago_s);
    x[kBoundary] = T(boundary);
    x[kSinceBoundary] = T(ago_s);
  }

  // x' = (omega - x) |omega| / A, implicit in the angle turned since the sample before
  template <typename T>
  static void lag_in_angle(const T* p, T* x, SensorPort<T>& port) {
    using std::abs;
    // A drive at rest passes no pulse and keeps its last speed; 1e-6 rad keeps the quotient defined at A = 0.
    const T turned_rad = abs(port.omega_rotor_rad_s) * port.dt_s + 1e-6;
    x[kSpeed] += (port.measured_speed_rad_s - x[kSpeed]) * (turned_rad / (p[kAngle] + turned_rad));
  }

  template <typename T>
  static void apply(const T* p, T* x, SensorPort<T>& port) {
    if (value_of(x[kStarted]) == 0.0 && port.dt_s <= 0.0) {
      x[kSpeed] = port.measured_speed_rad_s;
      if (value_of(p[kAngle]) > 0.0) x[kBoundary] = T(std::floor(value_of(port.theta_rotor_rad / p[kAngle])));
    } else if (port.noise != nullptr) {
      time_the_angle(p, x, port);
    } else {
      lag_in_angle(p, x, port);
    }
    x[kStarted] = T(1);
    // measured = (1 + e) x
    port.measured_speed_rad_s = (1.0 + p[kClockError]) * x[kSpeed];
  }
};

}  // namespace

OMNIHIL_EFFECT(hall_speed_period, HallSpeedPeriod)

}  // namespace omnihil
