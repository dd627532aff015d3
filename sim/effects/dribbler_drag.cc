// A ball held by the dribbler rubs on the carpet and holds the robot back.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

constexpr double kSmoothSpeed_m_s = 0.02;  // within it the force is proportional to the speed
constexpr double kOnSpeed_rad_s = 20.0;    // dribbler speed at which 71 % of the force is there

struct DribblerDrag {
  enum Param { kForce };
  static constexpr EffectParam kParams[] = {
      {.name = "force_N",
       .unit = "N",
       .typical = 0.4,
       .lower = 0,
       .upper = 20,
       .prior_scale = 1,
       .what = "drag while the dribbler turns and holds a ball",
       .how = "the same drive with the dribbler on and off: difference of the wheels' currents"},
  };
  static constexpr EffectInfo kInfo{
      .id = "dribbler_drag",
      .title = "Dribbler drag",
      .equation =
          "F = -F_d d / sqrt(d^2 + d_s^2) v / sqrt(v^2 + v_s^2); d dribbler speed, d_s = 20 rad/s, v "
          "of the robot's centre, v_s = 0.02 m/s",
      .source = "Coulomb 1785 at ball and carpet; roots: our smoothing",
      .cannot =
          "a ball that is lost, the yaw moment of a force at the mouth, the dribbler motor's own current",
      .place = Place::kBody,
      .twins = {"rolling_resistance"},
      .reveals =
          "one drive with the dribbler switched on and off: acceleration and currents change with its "
          "state alone",
      .visible = "current noise of one second's mean against the force shared by four wheels",
      .min_visible =
          [](const SensorSet& s) {
            // F r / (4 gear k): current per newton at 27 mm, gear 3, 25 mN m/A
            const double current_per_N = 0.027 / (4.0 * 3.0 * 0.025);
            return 3.0 * s.current_sigma_A / std::sqrt(4.0 * s.rate_Hz) / current_per_N;
          },
      .claims = kDissipative | kOdd,
      .rigs = kOnRobot,
      .demands = kNeedsDribbler,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, BodyPort<T>& port) {
    using std::sqrt;
    const T &vx = port.v_forward_m_s, &vy = port.v_left_m_s, &d = port.dribbler_rad_s;
    // F = -F_d d / sqrt(d^2 + d_s^2) v / sqrt(v^2 + v_s^2); turning either way
    const T size = value_of(d) < 0.0 ? T(-d) : d;
    const T force_s_per_m = p[kForce] * size / sqrt(d * d + kOnSpeed_rad_s * kOnSpeed_rad_s) /
                            sqrt(vx * vx + vy * vy + kSmoothSpeed_m_s * kSmoothSpeed_m_s);
    port.force_x_N -= force_s_per_m * vx;
    port.force_y_N -= force_s_per_m * vy;
  }
};

}  // namespace

OMNIHIL_EFFECT(dribbler_drag, DribblerDrag)

}  // namespace omnihil
