// Wheels of unequal radius: worn rings, another batch.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

// Wheel k of the robot.
#define RATIO(k, size)                                                                                       \
  {                                                                                                          \
    .name = "ratio_" #k, .unit = "1", .neutral = 1.0, .typical = size, .lower = 0.8, .upper = 1.25,          \
    .prior_scale = 0.01, .what = "radius of wheel " #k " over the model's",                                  \
    .how = "calliper; or counts of a turn on the spot and of straight drives against the camera", .wheel = k \
  }

struct WheelRadiusMismatch {
  static constexpr EffectParam kParams[] = {RATIO(1, 1.01),  RATIO(2, 0.99),  RATIO(3, 1.005),
                                            RATIO(4, 0.995), RATIO(5, 1.008), RATIO(6, 0.992)};
#undef RATIO
  static constexpr EffectInfo kInfo{
      .id = "wheel_radius_mismatch",
      .title = "Mismatch of wheel radii",
      .equation = "r_k = ratio_k r",
      .source =
          "Borenstein and Feng, IEEE Trans. Robotics and Automation 12(6), 1996 (systematic odometry errors)",
      .cannot =
          "wheels that are not round, a robot that leans on its smaller wheels (loads are those of equal "
          "wheels)",
      .place = Place::kContact,
      .twins = {"motor_mismatch"},
      .reveals =
          "straight drives at constant wheel speeds: yaw drift that grows with the distance, whatever the "
          "speed; wheel counts against the camera's path",
      .visible = "a camera that sees 0.01 rad of yaw over a drive of two metres",
      .min_visible =
          [](const SensorSet& s) {
            // yaw = 2 m * ratio / (4 R_b), R_b 80 mm; 0.01 rad per frame, one drive per 5 s
            return 0.01 * 4 * 0.08 / 2.0 / std::sqrt(0.2 * s.duration_s);
          },
      .rigs = kOnRobot,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, ContactPort<T>& port) {
    // r_k = ratio_k r
    port.wheel_radius_m *= p[port.wheel];
  }
};

}  // namespace

OMNIHIL_EFFECT(wheel_radius_mismatch, WheelRadiusMismatch)

}  // namespace omnihil
