// Rolling resistance: carpet and rubber give way under the wheel and take a torque that opposes rolling.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct RollingResistance {
  enum Param { kCoefficient };
  static constexpr EffectParam kParams[] = {
      {.name = "coefficient",
       .unit = "1",
       .typical = 0.02,  // 0.01 to 0.04 of the load on carpet (estimate)
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.03,
       .what = "resisting force at the rim over the wheel's load",
       .how = "the same slow speeds on the floor and lifted: difference of the currents"},
  };
  static constexpr EffectInfo kInfo{
      .id = "rolling_resistance",
      .title = "Rolling resistance",
      .equation = "tau_wheel = -c_r N r sgn(omega_wheel); at rest the wheel holds while it suffices",
      .source = "Coulomb 1785; Johnson, Contact Mechanics, 1985 (hysteresis in rolling)",
      .cannot =
          "growth with speed, the direction of the carpet's pile, holding a wheel whose motor is free "
          "beyond one step of the mechanics at a time",
      .place = Place::kContact,
      .twins = {"coulomb_friction"},
      .reveals =
          "the same profile on the floor and lifted: current against the direction of turning, "
          "proportional to the load",
      .visible = "the current noise of one second's mean against c N r / (gear k)",
      .min_visible =
          [](const SensorSet& s) {
            const double current_per_unit_A = 6.0 * 0.027 / (3.0 * 0.025);
            return 3.0 * s.current_sigma_A / std::sqrt(0.5 * s.rate_Hz) / current_per_unit_A;
          },
      .claims = kDissipative | kOdd,
      .rigs = kOnRobot,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, ContactPort<T>& port) {
    // level c_r N r; the framework opposes the motion with it and holds at zero
    port.friction_wheel_Nm += p[kCoefficient] * port.load_N * port.wheel_radius_m;
  }
};

}  // namespace

OMNIHIL_EFFECT(rolling_resistance, RollingResistance)

}  // namespace omnihil
