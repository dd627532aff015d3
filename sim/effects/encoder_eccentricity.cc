// Eccentricity of the encoder's disc or magnet: an angle error once per turn of its shaft.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct EncoderEccentricity {
  enum Param { kAmplitude, kPhase };
  static constexpr EffectParam kParams[] = {
      {.name = "amplitude_rad",
       .unit = "rad",
       .typical = 0.01,  // 0.2 to 1 deg (estimate)
       .lower = -0.1,    // the order that the law leaves out, (a / r)^2, is 1 % there
       .upper = 0.1,
       .prior_scale = 0.02,
       .what = "amplitude of the angle error, at the encoder's shaft",
       .how = "constant speed: ripple of the measured speed over the angle, divided by the speed"},
      phase_row("phase at encoder angle zero", "as amplitude_rad"),
  };
  static constexpr EffectInfo kInfo{
      .id = "encoder_eccentricity",
      .title = "Encoder eccentricity",
      .equation =
          "angle = theta + e sin(theta + p), speed = omega (1 + e cos(theta + p)), at the encoder's "
          "shaft",
      .source =
          "geometry (ours): a graduation of radius r whose centre is off its axis by a errs by (a / r) "
          "sin(theta + p) to first order in a / r",
      .cannot = "higher orders (tilted discs, magnets off axis: order 2), errors of interpolation",
      .place = Place::kSensor,
      .twins = {"imbalance"},
      .reveals =
          "constant speeds: ripple of the measured speed at order 1 of the encoder's shaft whose size "
          "grows in proportion to the speed, with nothing in the current",
      .visible = "an error of a count, averaged over the turns of the record",
      .min_visible =
          [](const SensorSet& s) {
            // Quantisation 1 / sqrt(12) count, averaged over the samples: 3 sigma sqrt(2 / n)
            const double step_rad = 6.283185307179586 / s.counts_per_turn;
            return 3.0 * step_rad / std::sqrt(12.0) * std::sqrt(2.0 / (s.rate_Hz * s.duration_s));
          },
      .demands = kNeedsAngle,
      .params = kParams,
      .plot = {.excitation = "turn", .x = "rotor_angle", .y = "encoder_error", .from_s = 0.0, .to_s = 4.0},
  };

  template <typename T>
  static void apply(const T* p, T*, SensorPort<T>& port) {
    using std::cos, std::sin;
    const T& turns = port.encoder_turns_per_rotor_turn;
    const T angle = port.theta_rotor_rad * turns + p[kPhase];
    // e sin(theta + p) at the encoder's shaft, seen from the rotor
    port.encoder_angle_rad += p[kAmplitude] * sin(angle) / turns;
    // its rate: e cos(theta + p) omega
    if (port.speed_is_the_encoders)
      port.measured_speed_rad_s += p[kAmplitude] * cos(angle) * port.omega_rotor_rad_s;
  }
};

}  // namespace

OMNIHIL_EFFECT(encoder_eccentricity, EncoderEccentricity)

}  // namespace omnihil
