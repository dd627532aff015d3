// Torque ripple: the torque constant depends on the rotor's angle, and the back-EMF with it.
#include <cmath>

#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"
#include "sim/law/fast_sin.h"

namespace omnihil {
namespace {

struct TorqueRipple {
  enum Param { kFraction, kOrder, kPhase };

  // Six commutations per electrical turn.
  static double order_of(const DriveParams<double>& drive) {
    return drive.pole_pairs > 0 ? 6.0 * drive.pole_pairs : 48.0;
  }

  static constexpr EffectParam kParams[] = {
      {.name = "fraction",
       .unit = "1",
       .typical = 0.04,  // 2 to 8 % (estimate); six-step with sinusoidal back-EMF: 4.5 % (Fourier series)
       .lower = -0.5,
       .upper = 0.5,
       .prior_scale = 0.05,
       .what = "amplitude over the mean torque constant",
       .how = "constant slow speed at three loads: current or torque at the order, over the mean"},
      order_row(48, 400, "periods per rotor turn", "six times the pole pairs, and multiples of that",
                order_of),
      phase_row("phase at rotor angle zero", "as fraction"),
  };
  static constexpr EffectInfo kInfo{
      .id = "torque_ripple",
      .title = "Torque ripple",
      .equation = "k -> k (1 + r cos(n theta + p)), torque constant and back-EMF constant alike",
      .source =
          "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. 2003; Jahns and Soong, IEEE "
          "Trans. Ind. Electron. 43(2), 1996",
      .cannot =
          "several harmonics at once, the spikes of commutation itself (the switched six-step drive has "
          "them), "
          "a torque without current (cogging)",
      .place = Place::kWinding,
      .twins = {"cogging", "dead_time"},
      .reveals =
          "constant slow speed at three loads: torque at the order n grows in proportion to the current; "
          "turned "
          "without current: back-EMF at the same order",
      .visible = "the speed ripple r tau / (J n omega) against the encoder's step, at 2 rad/s under 20 mN m",
      .min_visible =
          [](const SensorSet& s) {
            // r = J n omega d_omega / tau, J = 3e-5, n = 48, tau = 20 mN m; d_omega as for cogging
            const double speed_step_rad_s = 6.283185307179586 / s.counts_per_turn * s.rate_Hz;
            return 3e-5 * 48 * 2.0 / 0.02 * speed_step_rad_s / std::sqrt(s.rate_Hz * s.duration_s);
          },
      .claims = kOdd,
      .numerics = kFine,
      .of_angle = LawOfAngle::kRotor,
      .params = kParams,
      .plot = {.excitation = "creep", .x = "time", .y = "motor_current", .from_s = 0.5, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    // k -> k (1 + r cos(n theta + p)), mean over the sub-step
    const T turned = p[kOrder] * port.omega_rotor_rad_s * port.dt_s;
    const T factor =
        1.0 + p[kFraction] * cos_of(p[kOrder] * port.theta_rotor_rad + p[kPhase]) * turning_mean(turned);
    port.torque_constant_Nm_per_A *= factor;
    port.back_emf_V_s_per_rad *= factor;
  }
};

}  // namespace

OMNIHIL_EFFECT(torque_ripple, TorqueRipple)

}  // namespace omnihil
