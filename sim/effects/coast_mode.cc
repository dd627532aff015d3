// Bridge in coast mode: between the pulses its switches are open, and the current dies through the diodes.
#include <cmath>

#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct CoastMode {
  enum Param { kShare, kTimeConstant, kReturn };
  static constexpr double kAssumed_Hz = 20e3;  // where no PWM frequency is stated: common, above hearing
  static constexpr EffectParam kParams[] = {
      {.name = "coast_share",
       .unit = "1",
       .typical = 1.0,
       .lower = 0,
       .upper = 1.25,  // 1 is the most there is; the rest lets an estimate scatter about it
       .prior_scale = 0.5,
       .what = "share of the off-time in which the bridge floats (fast decay, asynchronous); in the rest it "
               "brakes",
       .how = "data sheet of the bridge; speed without load over duty: a straight line in brake mode, bent "
              "towards the top speed in coast mode"},
      {.name = "time_constant_s",
       .unit = "s",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 2e-4,  // 0.1 to 1 ms from inductance over resistance of data sheets, 6 to 24 V motors
       .lower = 1e-7,
       .upper = 1e-2,
       .what = "inductance over resistance of the winding; without a stated PWM frequency: times that over "
               "20 kHz",
       .how = "impedance meter; the same duty at two PWM frequencies",
       .start_for =
           [](const DriveParams<double>& d) {
             const bool known = d.inductance_H > 0.0 && d.resistance_ohm > 0.0;
             return known ? d.inductance_H / d.resistance_ohm : 2e-4;
           },
       // no inductance at one bound, no ripple at the other: both are bridges that cannot brake
       .trait = ParamTrait::kForm,
       .grid = {GridOf::kStart, {0.03, 0.25, 1.0, 4.0}}},
      {.name = "return_ratio",
       .unit = "1",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = 0.3,
       .lower = 0,
       .upper = 1.2,  // 1 and two diodes' drop over a small bus voltage
       .prior_scale = 0.5,
       .what = "voltage against which the current dies over the bus voltage: 1 where it returns to the bus "
               "through the diodes of an open bridge, about 0 where one diode shorts the winding",
       .how = "oscilloscope at the terminals while the current dies",
       .trait = ParamTrait::kForm},
  };
  static constexpr EffectInfo kInfo{
      .id = "coast_mode",
      .title = "Coast-mode switching (discontinuous conduction)",
      .equation =
          "u += s (u_c - D V); i_1 R = (V - e) (1 - exp(-D T / tau)), d = (tau / T) ln(1 + i_1 R / (r V "
          "+ e)); u_c = D V - d r V + (1 - D - d) e where D + d < 1, else D V - (1 - D) r V",
      .source =
          "Mohan, Undeland, Robbins, Power Electronics, 3rd ed. 2003, ch. 7 (discontinuous conduction); "
          "with the winding's resistance: derived here (docs/motor-model.md)",
      .cannot =
          "show the ripple of current and torque; diodes' losses of their own; regeneration into the bus "
          "above its voltage",
      .place = Place::kBridge,
      .twins = {"pwm_dead_band", "duty_limit"},
      .reveals =
          "staircase of the duty without load: the speed rises steeply at small duties and bends "
          "towards the top speed; at duty 0 the rotor coasts; another PWM frequency gives another curve",
      .visible = "the rise of the speed at half duty, 10 % of 12 V, in one second's mean current",
      .min_visible =
          [](const SensorSet& s) {
            // Brake mode to coast mode changes the mean voltage by some 10 % of 12 V, over 1.2 ohm 1 A.
            return 3.0 * s.current_sigma_A / 1.0 * std::sqrt(1.0 / s.rate_Hz);
          },
      .claims = kOdd,
      .demands = kNeedsDuty,
      .params = kParams,
      .plot = {.excitation = "ramp", .x = "duty", .y = "velocity", .from_s = 0.0, .to_s = 8.0},
  };

  // Mean voltage at the winding over a PWM period, positive duty.
  template <typename T>
  static T mean_voltage(const T& D, const T& V, const T& e, const T& decay, const T& r) {
    using std::exp;
    using std::log;
    if (value_of(e) >= value_of(V)) return D * V + (1.0 - D) * e;
    // i_1 R = (V - e) (1 - exp(-D T / tau))
    const T peak = (V - e) * (1.0 - exp(-D * decay)), against = r * V + e;
    const T continuous = D * V - (1.0 - D) * r * V;
    if (value_of(against) <= 0.0) return continuous;
    // d = (tau / T) ln(1 + i_1 R / (r V + e))
    const T dying = log(1.0 + peak / against) / decay;
    if (value_of(D) + value_of(dying) >= 1.0) return continuous;
    return D * V - dying * r * V + (1.0 - D - dying) * e;
  }

  template <typename T>
  static void apply(const T* p, T*, BridgePort<T>& port) {
    if (port.kind != CommandKind::kDuty && port.kind != CommandKind::kPositionTarget) return;
    if (value_of(port.bus_voltage_V) <= 0.0) return;
    const bool forward = value_of(port.duty_ratio) > 0.0 ||
                         (value_of(port.duty_ratio) == 0.0 && value_of(port.back_emf_V) >= 0.0);
    const double sign = forward ? 1.0 : -1.0;
    const T duty = sign * port.duty_ratio, emf = sign * port.back_emf_V;
    const T frequency = value_of(port.pwm_frequency_Hz) > 0.0 ? port.pwm_frequency_Hz : T(kAssumed_Hz);
    const T decay = 1.0 / (frequency * p[kTimeConstant]);  // T / tau
    const T coasting = mean_voltage(duty, port.bus_voltage_V, emf, decay, p[kReturn]);
    port.voltage_V += p[kShare] * sign * (coasting - duty * port.bus_voltage_V);
  }
};

}  // namespace

OMNIHIL_EFFECT(coast_mode, CoastMode)

}  // namespace omnihil
