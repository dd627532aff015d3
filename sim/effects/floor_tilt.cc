// A floor that is not level: a part of the weight pulls downhill.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

constexpr double kGravity_m_s2 = 9.80665;  // standard gravity, by definition

struct FloorTilt {
  enum Param { kAngle, kDirection };
  static constexpr EffectParam kParams[] = {
      {.name = "angle_rad",
       .unit = "rad",
       .typical = 0.0175,  // one degree: 0.43 N on 2.5 kg
       .lower = -0.2,
       .upper = 0.2,
       .prior_scale = 0.02,
       .what = "slope of the floor against the horizontal",
       .how = "spirit level; or coasting from rest: acceleration over gravity"},
      phase_row("downhill direction in the field, from x towards y",
                "direction in which the robot drifts when it coasts, whatever way it looks", "direction_rad",
                0.5),
  };
  static constexpr EffectInfo kInfo{
      .id = "floor_tilt",
      .title = "Tilt of the floor",
      .equation = "F = m g sin(angle) (cos(d - yaw), sin(d - yaw)) at the centre of mass, in the body frame",
      .source = "Stevin 1586, the inclined plane",
      .cannot =
          "an uneven floor, the load transfer across the slope and the loss cos(angle) of weight (0.02 % "
          "at one degree); the accelerometer's own tilt",
      .place = Place::kBody,
      .twins = {"constant_load"},
      .reveals =
          "coasting or slow drives, repeated with the robot turned by 180 degrees: a drift that keeps "
          "its direction in the field",
      .visible = "camera noise of 2 mm over the drift g sin(angle) t^2 / 2 of one second",
      .min_visible =
          [](const SensorSet& s) {
            // 3 sigma of the mean of a second's camera frames (60 Hz) or less often where samples are fewer
            const double frames = s.rate_Hz < 60.0 ? s.rate_Hz : 60.0;
            return 3.0 * 0.002 / std::sqrt(frames) / (0.5 * kGravity_m_s2);
          },
      .rigs = kOnRobot,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, BodyPort<T>& port) {
    using std::cos;
    using std::sin;
    const T force_N = port.mass_kg * kGravity_m_s2 * sin(p[kAngle]);
    const T direction = p[kDirection] - port.yaw_rad;
    const T x = force_N * cos(direction), y = force_N * sin(direction);
    port.force_x_N += x;
    port.force_y_N += y;
    // at the centre of mass: moment about the geometric centre
    port.torque_z_Nm += port.center_of_mass_x_m * y - port.center_of_mass_y_m * x;
  }
};

}  // namespace

OMNIHIL_EFFECT(floor_tilt, FloorTilt)

}  // namespace omnihil
