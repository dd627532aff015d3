// Ripple of the rollers: a drive force that comes once per roller, because the wheel is no circle.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct RollerRipple {
  enum Param { kFraction, kOrder, kPhase };
  static constexpr EffectParam kParams[] = {
      {.name = "fraction",
       .unit = "1",
       .typical = 0.06,  // 1 to 5 mN m at the motor of a geared wheel with 6 N of load (estimate)
       .lower = -0.5,
       .upper = 0.5,
       .prior_scale = 0.08,
       .what = "amplitude of the drive force over the wheel's load",
       .how = "constant speeds on the floor and lifted: line of the wheel speed at the rollers' order"},
      order_row(15, 100, "rollers per wheel turn", "count them; twice as many where two rings are offset"),
      phase_row("phase at wheel angle zero", "as fraction"),
  };
  static constexpr EffectInfo kInfo{
      .id = "roller_ripple",
      .title = "Roller ripple",
      .equation = "F_longitudinal += f N sin(n phi + p), phi of the wheel, N its load",
      .source =
          "virtual work of a load on a rim whose radius varies, F = -N dr/dphi / r: first harmonic only; "
          "Ferriere, Raucent, Campion, ICRA 1996 (gaps between rollers of omnimobile wheels)",
      .cannot =
          "the robot's bouncing and the load's own ripple, roller gaps that hit harder at speed, a side "
          "force; wheel angles start at zero where the simulation starts",
      .place = Place::kContact,
      .twins = {"cogging"},
      .reveals =
          "constant speeds on the floor and lifted: wheel speed over the wheel's angle, a line at the "
          "number of rollers that is gone when the wheel hangs free",
      .visible = "speed ripple f N r / (J n omega) of the wheel against one encoder count per sample",
      .min_visible =
          [](const SensorSet& s) {
            // f = J n omega d_omega / (N r): J 1e-4 at the wheel, n 15, 10 rad/s, N 6 N, r 27 mm, gear 3
            const double speed_step_rad_s = 6.283185307179586 / s.counts_per_turn * s.rate_Hz / 3.0;
            return 1e-4 * 15 * 10 * speed_step_rad_s / (6.0 * 0.027) / std::sqrt(s.rate_Hz * s.duration_s);
          },
      .rigs = kOnRobot,
      .of_angle = LawOfAngle::kOutput,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, ContactPort<T>& port) {
    using std::sin;
    // F += f N sin(n phi + p)
    port.force_longitudinal_N +=
        p[kFraction] * port.load_N * sin(p[kOrder] * port.theta_wheel_rad + p[kPhase]);
  }
};

}  // namespace

OMNIHIL_EFFECT(roller_ripple, RollerRipple)

}  // namespace omnihil
