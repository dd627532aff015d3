// Gravity on an eccentric load: an arm, a pendulum, a disc with a mass on it. Once per turn of the output.
#include <cmath>

#include "sim/law/effect_entry.h"
#include "sim/law/fast_sin.h"

namespace omnihil {
namespace {

struct GravityLoad {
  enum Param { kTorque, kPhase };
  static constexpr EffectParam kParams[] = {
      {.name = "torque_Nm",
       .unit = "N m",
       .typical = 0.02,  // 50 g at 40 mm
       .lower = -100,
       .upper = 100,
       .prior_scale = 0.1,
       .what = "m g l at the output shaft",
       .how = "holding current against angle over a turn: amplitude at once per turn"},
      phase_row("angle of the output at zero, from hanging straight down",
                "as torque_Nm: where the current is zero"),
  };
  static constexpr EffectInfo kInfo{
      .id = "gravity_load",
      .title = "Gravity load",
      .equation = "tau_out = -m g l sin(theta_out + p); at the rotor tau_out / N",
      .source = "Newton 1687; Craig, Introduction to Robotics, 3rd ed. 2005 (one link)",
      .cannot = "add the mass's inertia (load.inertia_kg_m2 does), tilt the axis of the shaft during a run",
      .place = Place::kTorque,
      .twins = {"imbalance", "load.gravity_torque_Nm"},
      .reveals =
          "slow turning or holding over a whole turn of the output: current at once per turn of the output, "
          "the "
          "same both ways",
      .visible = "three sigma of the current's once-per-turn line over the record",
      .min_visible =
          [](const SensorSet& s) {
            // amplitude of a line among n samples: sigma sqrt(2 / n), at 30 mN m/A
            return 3.0 * 0.03 * s.current_sigma_A * std::sqrt(2.0 / (s.rate_Hz * s.duration_s));
          },
      .claims = kConservative,
      .of_angle = LawOfAngle::kOutput,
      .excludes = {"load.gravity_torque_Nm", BaseExclusion::kWherePresent},
      .params = kParams,
      .plot = {.excitation = "turn", .x = "rotor_angle", .y = "load_torque", .from_s = 0.0, .to_s = 4.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    // tau = -m g l sin(theta_out + p) / N
    const T tau_Nm = -p[kTorque] * sin_of(port.theta_output_rad + p[kPhase]) / port.gear_ratio;
    port.tau_Nm += tau_Nm;
    port.tau_load_Nm += tau_Nm;  // for laws that look at the load
  }
};

}  // namespace

OMNIHIL_EFFECT(gravity_load, GravityLoad)

}  // namespace omnihil
