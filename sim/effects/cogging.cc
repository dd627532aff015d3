// Cogging: torque between magnets and slots that depends on the rotor's angle alone.
#include <cmath>
#include <numeric>

#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"
#include "sim/law/fast_sin.h"

namespace omnihil {
namespace {

// Number k = 2 … kHarmonics: two rows each, amplitude and phase.
#define HARMONIC(k)                               \
  {.name = "amplitude_" #k,                       \
   .unit = "N m",                                 \
   .role = ParamRole::kDetail,                    \
   .typical = 0.0005,                             \
   .lower = -10,                                  \
   .upper = 10,                                   \
   .prior_scale = 0.002,                          \
   .what = "amplitude at " #k " times the order", \
   .how = "as amplitude_Nm"},                     \
      phase_row("phase at " #k " times the order", "as phase_rad", "phase_" #k)

struct Cogging {
  static constexpr int kHarmonics = 24;
  enum Param { kAmplitude, kOrder, kPhase, kFirstHarmonic, kHighest = kFirstHarmonic + 2 * (kHarmonics - 1) };
  static constexpr int kDerived = 1;  // the highest harmonic in use

  // Order of a turn: least common multiple of poles and slots (Hanselman 2003).
  static double order_of(const DriveParams<double>& drive) {
    return drive.pole_pairs > 0 && drive.slots > 0 ? std::lcm(2 * drive.pole_pairs, drive.slots) : 48.0;
  }

  static constexpr EffectParam kParams[] = {
      {.name = "amplitude_Nm",
       .unit = "N m",
       .typical = 0.004,  // MN4004, 24 poles, 18 slots: 3.9 mN m rms (measured)
       .lower = -10,
       .upper = 10,
       .prior_scale = 0.01,
       .what = "amplitude at the order",
       .how = "standstill map: holding current against angle, mean of both directions"},
      order_row(48, 400, "periods per rotor turn",
                "least common multiple of poles and slots; divisors of it when the motor is uneven", order_of,
                {.first_row = kFirstHarmonic, .stride = 2, .count = kHarmonics - 1}),
      phase_row("phase at rotor angle zero", "as amplitude_Nm"),
      HARMONIC(2),
      HARMONIC(3),
      HARMONIC(4),
      HARMONIC(5),
      HARMONIC(6),
      HARMONIC(7),
      HARMONIC(8),
      HARMONIC(9),
      HARMONIC(10),
      HARMONIC(11),
      HARMONIC(12),
      HARMONIC(13),
      HARMONIC(14),
      HARMONIC(15),
      HARMONIC(16),
      HARMONIC(17),
      HARMONIC(18),
      HARMONIC(19),
      HARMONIC(20),
      HARMONIC(21),
      HARMONIC(22),
      HARMONIC(23),
      HARMONIC(24),
  };
  static constexpr EffectInfo kInfo{
      .id = "cogging",
      .title = "Cogging",
      .equation = "tau += A sin(n theta + p) + sum_k A_k sin(k n theta + p_k), theta of the rotor",
      .source = "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. 2003",
      .cannot =
          "change with current (torque_ripple does), with temperature or with the axial position of the "
          "rotor",
      .place = Place::kTorque,
      .twins = {"torque_ripple", "roller_ripple"},
      .reveals =
          "standstill map, or 2 to 10 rad/s both ways: speed and current against rotor angle, at the order n",
      .visible = "the speed ripple A / (J n omega) against the encoder's step, at a creep of 2 rad/s",
      .min_visible =
          [](const SensorSet& s) {
            // A = J n omega * d_omega, d_omega: one count per second of averaging at one order; J = 3e-5, n
            // = 48.
            const double speed_step_rad_s = 6.283185307179586 / s.counts_per_turn * s.rate_Hz;
            return 3e-5 * 48 * 2.0 * speed_step_rad_s / std::sqrt(s.rate_Hz * s.duration_s);
          },
      .claims = kConservative,
      .numerics = kFine,
      .of_angle = LawOfAngle::kRotor,
      .params = kParams,
      .plot = {.excitation = "turn", .x = "rotor_angle", .y = "load_torque", .from_s = 0.0, .to_s = 4.0},
  };

  template <typename T>
  static void prepare(const T* p, T* highest) {
    int k = kHarmonics;
    while (k > 1 && is_exactly(p[kFirstHarmonic + 2 * (k - 2)], 0.0)) --k;
    *highest = T(k);
  }

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    // tau += A sin(n theta + p), mean over the sub-step
    const T angle = p[kOrder] * port.theta_rotor_rad;
    const T turned = p[kOrder] * port.omega_rotor_rad_s * port.dt_s;
    port.tau_Nm += p[kAmplitude] * sin_of(angle + p[kPhase]) * turning_mean(turned);
    // tau += A_k sin(k n theta + p_k)
    const double highest = value_of(p[kHighest]);
    for (int k = 2; k <= highest; ++k) {
      const T* h = p + kFirstHarmonic + 2 * (k - 2);
      if (is_exactly(h[0], 0.0)) continue;
      port.tau_Nm += h[0] * sin_of(double(k) * angle + h[1]) * turning_mean(T(double(k) * turned));
    }
  }
};
#undef HARMONIC

}  // namespace

OMNIHIL_EFFECT(cogging, Cogging)

}  // namespace omnihil
