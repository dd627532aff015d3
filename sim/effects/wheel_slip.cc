// Longitudinal slip: the wheel has to slide a little to push, and pushes no harder than its grip.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct WheelSlip {
  static constexpr double kSoft_m_s = 0.01;  // v_s: a stiffer contact than this begins to be the base model's
  enum Param { kCompliance, kGrip };
  static constexpr EffectParam kParams[] = {
      {.name = "compliance_m_s",
       .unit = "m/s",
       .typical = 0.1,  // rubber ring on carpet: onset of sliding at 4 to 7 m/s2 (estimate)
       .lower = 0,
       .upper = 5,
       .prior_scale = 0.2,
       .what = "sliding speed, on top of the base model's, at which the full grip is reached",
       .how = "ramps of the acceleration: speed of the wheels' rims less the robot's own (camera, IMU)"},
      {.name = "grip",
       .unit = "1",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 0.6,
       .lower = 0.05,
       .upper = 2,
       .prior_scale = 0.2,
       .what = "peak friction coefficient; the smaller of it and the base model's holds",
       .how = "largest acceleration over standard gravity on the floor, driven straight ahead"},
  };
  static constexpr EffectInfo kInfo{
      .id = "wheel_slip",
      .title = "Wheel slip",
      .equation =
          "v_slide = v_rim - v_hub; force = load f(v_slide / (v_0 + v_c)), full grip at v_0 + v_c, |f| "
          "<= mu; v_0 of the base model; below v_c = 10 mm/s mu comes in with v_c",
      .source =
          "Pacejka, Tire and Vehicle Dynamics, 3rd ed. 2012 (stiffness, peak and sliding); the "
          "sliding speed in place of its slip ratio is our choice, for starts from rest",
      .cannot =
          "coupling of drive and side force, roller by roller contact, warm-up or dust; the shape of the "
          "curve beyond its peak is the base model's",
      .place = Place::kContact,
      .twins = {"saturation", "current_limit"},
      .reveals =
          "ramps of the acceleration: wheel speed against body speed (camera or IMU); without a body "
          "speed it cannot be told from less torque",
      .visible =
          "one encoder count per sample at the rim, averaged over a tenth of a second of hard "
          "acceleration; twice that with the camera's own noise",
      .min_visible =
          [](const SensorSet& s) {
            // rim speed of one count per sample at gear 3, wheel radius 27 mm, half the full grip in use
            const double rim_step_m_s = 6.283185307179586 / s.counts_per_turn * s.rate_Hz / 3.0 * 0.027;
            return 2.0 * rim_step_m_s / std::sqrt(0.1 * s.rate_Hz) * 2.0;
          },
      .rigs = kOnRobot,
      .demands = kNeedsBodySpeed,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, ContactPort<T>& port) {
    port.slip_speed_m_s += p[kCompliance];
    // Without compliance the effect is not there, and its grip limits nothing: 1 / mu comes in over v_s.
    const double base = value_of(port.grip_coefficient);
    if (value_of(p[kCompliance]) <= 0.0 || (base > 0.0 && value_of(p[kGrip]) >= base)) return;
    if (value_of(p[kCompliance]) >= kSoft_m_s) {
      port.grip_coefficient = p[kGrip];
      return;
    }
    const T share = p[kCompliance] / kSoft_m_s;
    const T limit = base > 0.0 ? T(1.0 / port.grip_coefficient) : T(0);  // of infinite grip
    port.grip_coefficient = 1.0 / (limit + (1.0 / p[kGrip] - limit) * share);
  }
};

}  // namespace

OMNIHIL_EFFECT(wheel_slip, WheelSlip)

}  // namespace omnihil
