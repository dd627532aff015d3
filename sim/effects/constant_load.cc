// A load that always pushes the same way: slope, spring, cable, magnet.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct ConstantLoad {
  enum Param { kTorque };
  static constexpr EffectParam kParams[] = {
      {.name = "torque_Nm",
       .unit = "N m",
       .typical = 0.005,  // a slope of 1 degree under a robot of 2.5 kg: 1.4 mN m at each motor (estimate)
       .lower = -100,
       .upper = 100,
       .prior_scale = 0.02,
       .what = "torque on the output shaft, positive pushes forwards",
       .how = "half the sum of the steady currents at one speed both ways, times torque constant and gear "
              "ratio"},
  };
  static constexpr EffectInfo kInfo{
      .id = "constant_load",
      .title = "Constant load",
      .equation = "tau_out = M; at the rotor M / N",
      .source =
          "Newton 1687; catalogue of parasitic loads: Armstrong-Helouvry, Control of Machines with Friction, "
          "1991",
      .cannot = "depend on position (gravity_load does), start or end during a run",
      .place = Place::kTorque,
      .twins = {"friction_asymmetry", "floor_tilt"},
      .reveals =
          "the same speed both ways, and rest: currents differ by the same amount at every speed; turn the "
          "mounting over: its sign turns",
      .visible = "three sigma of the mean current of one second each way",
      .min_visible =
          [](const SensorSet& s) { return 3.0 * 0.03 * s.current_sigma_A / std::sqrt(2.0 * s.rate_Hz); },
      .params = kParams,
      .plot = {.excitation = "creep", .x = "duty", .y = "velocity", .from_s = 0.0, .to_s = 16.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    // tau = M / N
    const T tau_Nm = p[kTorque] / port.gear_ratio;
    port.tau_Nm += tau_Nm;
    port.tau_load_Nm += tau_Nm;  // for laws that look at the load
  }
};

}  // namespace

OMNIHIL_EFFECT(constant_load, ConstantLoad)

}  // namespace omnihil
