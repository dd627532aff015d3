// Mass that the model does not know of: a second battery, armour, another kicker.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct Payload {
  enum Param { kMass };
  static constexpr EffectParam kParams[] = {
      {.name = "mass_kg",
       .unit = "kg",
       .typical = 0.3,
       .lower = 0,
       .upper = 5,
       .prior_scale = 0.3,
       .what = "added mass, spread like the robot's own",
       .how = "a scale; or the same duty steps with and without a known mass on top"},
  };
  static constexpr EffectInfo kInfo{
      .id = "payload",
      .title = "Payload",
      .equation = "m += m_p; I += I m_p / m; the centre of mass stays",
      .source = "Newton's second law; a body scaled in density keeps its radii of gyration",
      .cannot =
          "a mass off the robot's own centre of mass (center_of_mass_offset), at another height, or that "
          "swings",
      .place = Place::kBody,
      .twins = {"robot.mass_kg"},
      .reveals =
          "duty steps on the floor: acceleration per current smaller by m / (m + m_p), lifted the same",
      .visible = "a hundredth of the robot's mass with ten steps of full duty",
      .min_visible =
          [](const SensorSet& s) {
            // d m / m = speed step of one count over the speed gained in a step of 2 m/s, ten steps
            const double rim_step_m_s = 6.283185307179586 / s.counts_per_turn * s.rate_Hz / 3.0 * 0.027;
            return 2.4 * 3.0 * rim_step_m_s / 2.0 / std::sqrt(0.5 * s.duration_s * s.rate_Hz);
          },
      .rigs = kOnRobot,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, BodyPort<T>& port) {
    // I += I m_p / m
    port.yaw_inertia_kg_m2 += port.yaw_inertia_kg_m2 * p[kMass] / port.mass_kg;
    port.mass_kg += p[kMass];
  }
};

}  // namespace

OMNIHIL_EFFECT(payload, Payload)

}  // namespace omnihil
