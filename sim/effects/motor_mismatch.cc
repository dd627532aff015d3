// Motors that are not alike: each wheel's torque constant apart from the model's.
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

// Wheel k of the robot.
#define RATIO(k, size)                                                                             \
  {                                                                                                \
    .name = "ratio_" #k, .unit = "1", .neutral = 1.0, .typical = size, .lower = 0.5, .upper = 1.5, \
    .prior_scale = 0.05, .what = "torque constant of motor " #k " over the model's",               \
    .how = "all lifted at one duty: no-load speeds, as one over the ratio", .wheel = k             \
  }

struct MotorMismatch {
  static constexpr EffectParam kParams[] = {RATIO(1, 1.04), RATIO(2, 0.97), RATIO(3, 0.98),
                                            RATIO(4, 1.03), RATIO(5, 1.02), RATIO(6, 0.99)};
#undef RATIO
  static constexpr EffectInfo kInfo{
      .id = "motor_mismatch",
      .title = "Mismatch of motors",
      .equation = "k = ratio_k k_model, torque and back-EMF alike",
      .source =
          "production spread of data sheets, +-3 to 8 %; 4 to 9 % between two motors measured on a "
          "micromouse",
      .cannot = "friction or resistance that differ between motors",
      .place = Place::kWinding,
      .twins = {"wheel_radius_mismatch"},
      .reveals =
          "the same duty on all wheels, lifted: speeds apart by the ratios; on the floor a yaw drift that "
          "stays with the motor when wheels are swapped",
      .visible = "speed of one second's mean at one count per sample, of 300 rad/s",
      .min_visible =
          [](const SensorSet& s) {
            const double speed_step_rad_s = 6.283185307179586 / s.counts_per_turn * s.rate_Hz;
            return speed_step_rad_s / s.rate_Hz / 300.0;
          },
      .rigs = kOnRobot,
      .demands = kNeedsSeveralMotors,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    // k = ratio_k k_model
    port.torque_constant_Nm_per_A *= p[port.wheel];
    port.back_emf_V_s_per_rad *= p[port.wheel];
  }
};

}  // namespace

OMNIHIL_EFFECT(motor_mismatch, MotorMismatch)

}  // namespace omnihil
