// Friction of the rollers in their bearings: a force across the drive direction.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

// Within it the force is proportional to the speed, so that an explicit step stays stable.
constexpr double kSmoothSpeed_m_s = 0.02;

struct LateralRollerFriction {
  enum Param { kCoefficient };
  static constexpr EffectParam kParams[] = {
      {.name = "coefficient",
       .unit = "1",
       .typical = 0.06,  // 3 to 10 % of the load (estimate)
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.08,
       .what = "side force over wheel load while the rollers turn, on top of the base model's",
       .how = "push the robot with its wheels held and rollers rolling: force over weight"},
  };
  static constexpr EffectInfo kInfo{
      .id = "lateral_roller_friction",
      .title = "Lateral roller friction",
      .equation = "F_lateral -= mu_r N v / sqrt(v^2 + v_s^2), v of the hub along the axle, v_s = 0.02 m/s",
      .source =
          "Coulomb 1785 at the rollers' journals; root: our smoothing; size after Williams, Carter, "
          "Gallina, Rosati, IEEE Trans. Robotics and Automation 18(3), 2002",
      .cannot = "holding a robot on a slope (below v_s the force fades), rollers that jam, change with speed",
      .place = Place::kContact,
      .twins = {"rolling_resistance"},
      .reveals =
          "drives in many directions, 0 to 360 degrees at one speed: what the wheels must push, largest "
          "along an axle",
      .visible = "the current noise of one second's mean against the force that one wheel's load makes",
      .min_visible =
          [](const SensorSet& s) {
            // mu N r / (gear k): current per coefficient at 6 N, 27 mm, gear 3, 25 mN m/A; four motors share
            const double current_per_unit_A = 6.0 * 0.027 / (3.0 * 0.025);
            return 3.0 * s.current_sigma_A / std::sqrt(s.rate_Hz) / current_per_unit_A;
          },
      .claims = kDissipative | kOdd,
      .rigs = kOnRobot,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, ContactPort<T>& port) {
    using std::sqrt;
    // F -= mu N v / sqrt(v^2 + v_s^2)
    const T& v = port.v_lateral_m_s;
    port.force_lateral_N -=
        p[kCoefficient] * port.load_N * v / sqrt(v * v + kSmoothSpeed_m_s * kSmoothSpeed_m_s);
  }
};

}  // namespace

OMNIHIL_EFFECT(lateral_roller_friction, LateralRollerFriction)

}  // namespace omnihil
