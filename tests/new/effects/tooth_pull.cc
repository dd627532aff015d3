// Throw-away: a torque twice per output turn whose angle goes round, under a name that no code knows.
#include "sim/law/effect_entry.h"
#include "sim/law/fast_sin.h"

namespace omnihil {
namespace {

struct ToothPull {
  enum Param { kPull, kNotch };
  static constexpr EffectParam kParams[] = {
      {.name = "pull_Nm",
       .unit = "N m",
       .typical = 0.005,
       .lower = -1,
       .upper = 1,
       .prior_scale = 0.02,
       .what = "amplitude",
       .how = "slow turning: current against angle"},
      phase_row("where the pull is zero", "as pull_Nm", "notch_rad", 0.3),
  };
  static constexpr EffectInfo kInfo{
      .id = "tooth_pull",
      .title = "Pull of a tooth",
      .equation = "tau = A sin(2 theta + n)",
      .source = "a test's own",
      .cannot = "anything else",
      .place = Place::kTorque,
      .reveals = "slow turning: current twice per turn",
      .visible = "as imbalance",
      .claims = kConservative,
      .of_angle = LawOfAngle::kRotor,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    // tau = A sin(2 theta + n)
    port.tau_Nm += p[kPull] * sin_of(2.0 * port.theta_rotor_rad + p[kNotch]);
  }
};

}  // namespace

OMNIHIL_EFFECT(tooth_pull, ToothPull)

}  // namespace omnihil
