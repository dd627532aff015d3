// LuGre friction: bristles that bend before they slide, so that a rotor creeps elastically before it breaks
// away.
#include <algorithm>
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct LugreFriction {
  enum Param { kCoulomb, kStatic, kSpeed, kStiffness, kDamping };
  enum State { kDeflection, kAngle, kStarted };
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
      {.name = "deflection", .unit = "rad"},
      {.name = "angle_before", .unit = "rad"},
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
    using std::abs;
    using std::exp;
    const T& omega = port.omega_rotor_rad_s;
    // g(omega): level while sliding at this speed
    T level = p[kCoulomb];
    if (value_of(p[kStatic]) >= value_of(level)) {
      const T ratio = omega / p[kSpeed];
      const T power = ratio * ratio;
      if (value_of(power) < 40.0) level += (p[kStatic] - p[kCoulomb]) * exp(-power);
    }
    // Turned since the middle of the sub-step before. By the angle, so that nothing drifts while it sticks.
    const bool started = value_of(x[kStarted]) > 0.0;
    const T way = started ? T(port.theta_rotor_rad - x[kAngle]) : T(0.5 * port.dt_s * omega);
    const T before = x[kDeflection];
    T& z = x[kDeflection];
    T bending = T(0);  // dz/dtheta, mean over the way
    // Less than this share of the bristles' length is differences of nearly equal numbers: its limit instead.
    constexpr double kShortest = 1e-8, kLeastLevel_Nm = 1e-20;
    const double length = std::max(value_of(level), kLeastLevel_Nm);
    if (value_of(p[kStiffness]) * std::abs(value_of(way)) > kShortest * length) {
      // Exact for a level held over the way: z -> z_s + (z - z_s) exp(-s0 |way| / g), z_s = g sgn(way) / s0
      const T sliding = sign_of(way) * level / p[kStiffness];
      z = sliding;
      if (value_of(level) > 0.0) {
        const T bent = p[kStiffness] * abs(way) / level;
        if (value_of(bent) < 700.0) z += (before - sliding) * exp(-bent);
      }
      bending = (z - before) / way;
    } else if (value_of(level) > kLeastLevel_Nm) {
      bending = 1.0 - p[kStiffness] * z * sign_of(value_of(way) != 0.0 ? way : omega) / level;
      z += bending * way;
    }
    x[kAngle] = port.theta_rotor_rad;
    x[kStarted] = T(1);
    // tau = -(s0 z + s1 dz/dtheta omega); the second part implicitly where it damps
    port.tau_Nm -= p[kStiffness] * z;
    const T damping = p[kDamping] * bending;
    if (value_of(damping) >= 0.0) {
      port.add_viscous(damping);
    } else {
      port.tau_Nm -= damping * omega;
    }
  }
};

}  // namespace

OMNIHIL_EFFECT(lugre_friction, LugreFriction)

}  // namespace omnihil
