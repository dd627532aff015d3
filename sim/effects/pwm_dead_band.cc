// Dead band of a bridge in coast mode: below some duty no current builds up, so nothing is driven or braked.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct PwmDeadBand {
  enum Param { kDuty };
  static constexpr double kEdge = 0.1;  // half the width of the band's edge, of the band: our choice
  static constexpr EffectParam kParams[] = {
      {.name = "duty",
       .unit = "1",
       .typical = 0.05,  // a few per cent at 20 kHz (guess, a factor of 2 either way); less at low PWM rates
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.05,
       .what = "duty below which the bridge drives nothing",
       .how = "staircase of small duties, both ways: duty of the first current; compare two PWM frequencies"},
  };
  static constexpr EffectInfo kInfo{
      .id = "pwm_dead_band",
      .title = "Dead band of coast-mode switching",
      .equation =
          "u = e + w (D V - e), w = 0 for |D| <= 0.9 d, 1 for |D| >= 1.1 d, linear between; e the "
          "back-EMF: no current where w = 0",
      .source =
          "Mohan, Undeland, Robbins, Power Electronics, 3rd ed. 2003 (discontinuous conduction: "
          "switch pulses too short to build up a current); sharp band: our simplification",
      .cannot =
          "the quadratic rise of the current in discontinuous conduction, a band that changes with "
          "speed; brake (the base model's bridge does) within the band: there the rotor coasts",
      .place = Place::kBridge,
      .twins = {"coulomb_friction", "dead_time"},
      .reveals =
          "slow ramps of the duty through zero, and coasting at duty 0: no current at all within the "
          "band, the full line outside it; changes with the PWM frequency, not with the load",
      .visible = "the duty whose stall current is three times the noise of one second's mean",
      .min_visible =
          [](const SensorSet& s) {
            // Stall current per duty: 10 A (12 V, 1.2 ohm); mean of a tenth of a second within the band.
            const double samples = s.rate_Hz * 0.1;
            return 3.0 * s.current_sigma_A / 10.0 / (samples > 1 ? std::sqrt(samples) : 1.0);
          },
      .claims = kOdd | kFlatAtNeutral,
      .demands = kNeedsDuty,
      .params = kParams,
      .plot = {.excitation = "creep", .x = "duty", .y = "motor_current", .from_s = 0.0, .to_s = 8.0},
  };

  template <typename T>
  static void apply(const T* p, T*, BridgePort<T>& port) {
    if (port.kind != CommandKind::kDuty && port.kind != CommandKind::kPositionTarget) return;
    const T& d = p[kDuty];
    const T size = value_of(port.duty_ratio) < 0.0 ? T(-port.duty_ratio) : port.duty_ratio;
    if (value_of(size) >= (1.0 + kEdge) * value_of(d)) return;
    // w = (|D| - 0.9 d) / (0.2 d)
    T share = T(0);
    if (value_of(size) > (1.0 - kEdge) * value_of(d)) {
      share = (size - (1.0 - kEdge) * d) / (2.0 * kEdge * d);
    }
    // u = e + w (D V - e)
    port.voltage_V = port.back_emf_V + share * (port.voltage_V - port.back_emf_V);
  }
};

}  // namespace

OMNIHIL_EFFECT(pwm_dead_band, PwmDeadBand)

}  // namespace omnihil
