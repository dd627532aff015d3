// LuGre friction: bristles that bend before they slide, so that a rotor creeps elastically before it breaks
// away.
#include <algorithm>
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct LugreFriction {
  enum Param { kCoulomb, kStatic, kSpeed, kStiffness, kDamping };
  enum State { kDeflection, kAngle, kStartLevel, kMiddleLevel, kStarted };
  static constexpr EffectParam kParams[] = {
      {.name = "coulomb_torque_Nm",
       .unit = "N m",
       .typical = 0.003,  // as coulomb_friction
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.01,
       .what = "friction torque when sliding fast",
       .how = "as coulomb_friction.torque_Nm"},
      {.name = "static_torque_Nm",
       .unit = "N m",
       .typical = 0.0045,  // 1.2 to 1.8 times the Coulomb level (estimate)
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.01,
       .what = "friction torque when sliding very slowly; below coulomb_torque_Nm: as if equal to it",
       .how = "torque at breakaway, reached slowly"},
      {.name = "stribeck_speed_rad_s",
       .unit = "rad/s",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 5,  // as stribeck_friction
       .lower = 0.05,
       .upper = 500,
       .prior_scale = 10,
       .what = "rotor speed at which 37 % of the excess of static over Coulomb is left",
       .how = "steady current at many low speeds",
       .grid = {GridOf::kTopSpeed, {0.01, 0.04, 0.15}}},
      {.name = "stiffness_Nm_per_rad",
       .unit = "N m/rad",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 3,  // breakaway after about 1 mrad, as Canudas de Wit and Lischinsky 1997 found on a servo
       .lower = 0.001,
       .upper = 1e4,
       .prior_scale = 10,
       .what = "of the bristles: torque over angle before breakaway",
       .how = "currents below breakaway, up and down: slope of torque over angle; needs a fine encoder"},
      {.name = "damping_Nm_s_per_rad",
       .unit = "N m s/rad",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 0.01,  // about critical for 3e-5 kg m2 on that stiffness
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.02,
       .what = "of the bristles while they bend",
       .how = "small current step below breakaway: ringing of the angle"},
  };
  static constexpr EffectState kStates[] = {
      {.name = "deflection", .unit = "rad"},     {.name = "angle_before", .unit = "rad"},
      {.name = "level_at_start", .unit = "N m"}, {.name = "level_in_middle", .unit = "N m"},
      {.name = "started", .unit = "1"},
  };
  static constexpr EffectInfo kInfo{
      .id = "lugre_friction",
      .title = "LuGre friction",
      .equation =
          "tau = -(s0 z + s1 dz/dt); dz/dtheta = 1 - s0 z sgn(omega) / g; g = c + max(s - c, 0) "
          "exp(-(omega / omega_s)^2)",
      .source =
          "Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Autom. Control 40(3), 1995 "
          "(without the viscous term, which the motor has)",
      .cannot =
          "hold for ever: under a torque that trembles below breakaway the bristles drift; remember several "
          "reversals at once as Prandtl's elements do",
      .place = Place::kTorque,
      .twins = {"stribeck_friction"},
      .nests = {"coulomb_friction", "stribeck_friction"},
      .reveals =
          "current up and down below breakaway: angle follows like a spring with hysteresis; very slow "
          "turning "
          "both ways: current falls with speed",
      .visible =
          "as Coulomb friction three sigma of a second's mean current; its stiffness only where breakaway / "
          "stiffness exceeds an encoder count",
      .min_visible =
          [](const SensorSet& s) { return 0.03 * 3.0 * s.current_sigma_A * std::sqrt(2.0 / s.rate_Hz); },
      .claims = kOdd,
      .numerics = kStiff,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "creep", .x = "duty", .y = "velocity", .from_s = 0.0, .to_s = 16.0},
  };

  template <typename T>
  static void apply(const T* p, T* x, TorquePort<T>& port) {
    using std::exp;
    const T& omega = port.omega_rotor_rad_s;
    // g(omega): level while sliding at this speed
    T level = p[kCoulomb];
    if (value_of(p[kStatic]) >= value_of(level)) {
      const T ratio = omega / p[kSpeed];
      const T power = ratio * ratio;
      if (value_of(power) < 40.0) level += (p[kStatic] - p[kCoulomb]) * exp(-power);
    }
    // The port shows the sub-step's middle; levels at its ends are taken from this middle and the one before. Up to
    // its start the bristles have followed the rotor's own way (by the angle, so that nothing drifts while it
    // sticks); over it they are led on at the middle's speed.
    const double h = port.dt_s;
    const bool started = value_of(x[kStarted]) > 0.0;
    const T start_rad = port.travel_rad - 0.5 * h * omega;
    const T start_level = started ? T(0.5 * (x[kMiddleLevel] + level)) : level;
    T end_level = 2.0 * level - start_level;
    if (value_of(end_level) < value_of(p[kCoulomb])) end_level = p[kCoulomb];
    T& z = x[kDeflection];
    if (started) z = bent(p[kStiffness], {x[kStartLevel], start_level}, z, T(start_rad - x[kAngle])).end;
    x[kAngle] = start_rad;
    x[kStartLevel] = start_level;
    x[kMiddleLevel] = level;
    x[kStarted] = T(1);
    const Bent<T> over = bent(p[kStiffness], {start_level, end_level}, z, T(h * omega));
    // tau = -(s0 mean z + s1 dz/dtheta omega). The second part implicitly in the speed where it damps; of the
    // first the change with the speed, h/2 s0 dz/dtheta, so that no stiffness asks for a shorter sub-step.
    port.tau_Nm -= p[kStiffness] * over.mean;
    const T spring = 0.5 * h * p[kStiffness] * over.slope;
    if (value_of(spring) > 0.0) {
      port.tau_Nm += spring * omega;
      port.add_viscous(spring);
    }
    const T damping = p[kDamping] * over.slope;
    if (value_of(damping) >= 0.0) {
      port.add_viscous(damping);
    } else {
      port.tau_Nm -= damping * omega;
    }
  }

 private:
  template <typename T>
  struct Levels {
    T from, to;  // while sliding, at the way's start and end, N m
  };

  template <typename T>
  struct Bent {
    T end, mean, slope;  // deflection at the way's end and its mean over the way, rad; mean dz/dtheta
  };

  // Bristles at deflection z, led along `way` while the level changes in proportion to it, u = 0 … 1:
  //   dz/du = b (z_s(u) - z),   b = s0 |way| / g,   z_s = sgn(way) g(u) / s0 from z_0 to z_0 + d
  //   z(1) = z + b (e1 (z_0 - z) + e2 d),   e1 = (1 - exp(-b)) / b,   e2 = (1 - e1) / b
  template <typename T>
  static Bent<T> bent(const T& stiffness, const Levels<T>& level, const T& z, const T& way) {
    using std::exp;
    constexpr double kLeastLevel_Nm = 1e-20;  // numerical: below it there is no friction
    const T mean_level = 0.5 * (level.from + level.to);
    const double sign = value_of(way) < 0.0 ? -1.0 : 1.0;
    if (value_of(mean_level) < kLeastLevel_Nm) {  // b without bound: they slide from the first
      if (is_exactly(way, 0.0)) return {z, z, T(0)};
      return {T(sign * level.to / stiffness), T(sign * mean_level / stiffness), T(0)};
    }
    const T per_rad = sign * stiffness / mean_level;  // b / way
    const T b = per_rad * way;
    T e1, e2;
    if (value_of(b) < 1e-3) {  // numerical: below it the series is exact to 1e-13, above it the difference
      e1 = 1.0 - b * (0.5 - b * (1.0 / 6.0 - b / 24.0));
      e2 = 0.5 - b * (1.0 / 6.0 - b * (1.0 / 24.0 - b / 120.0));
    } else {
      e1 = (value_of(b) < 40.0 ? T(1.0 - exp(-b)) : T(1.0)) / b;
      e2 = (1.0 - e1) / b;
    }
    const T from = sign * level.from / stiffness, change = sign * (level.to - level.from) / stiffness;
    const T slope = per_rad * (e1 * (from - z) + e2 * change);
    return {T(z + slope * way), T(from + (z - from) * e1 + change * (0.5 - e2)), slope};
  }
};

}  // namespace

OMNIHIL_EFFECT(lugre_friction, LugreFriction)

}  // namespace omnihil
