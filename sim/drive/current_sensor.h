// A shunt, an amplifier and an ADC: from a true current to counts and to what the firmware makes of them.
//
//   CurrentSensor s{.shunt_ohm = 2e-3, .amplifier_gain = 20, .reference_V = 3.3, .bits = 12};
//   int counts = adc_counts(s, 3.0, {seed, stream, sample});          // 2048 + 3 * 2e-3 * 20 / 3.3 * 4096
//   double i = current_of_counts(s, counts);                          // with nominal gain and offset
//
// Law: v = v_ref / 2 + (i R_shunt) A (1 + gain error) + offset + noise;  counts = floor(v 2^bits / v_ref),
//      held to 0 .. 2^bits - 1.  The firmware knows shunt, gain and reference, not the errors.
// When: sample_ratio of the PWM period, given to advance_period (0.5: middle of the on-time of high-side
// legs). Where: a shunt in the phase sees the current always; one in the low side only while that leg's lower
// switch is on (otherwise the reading is that of no current); one in the bus return sees the sum of the legs
// that are connected to the positive rail. Source: application notes of three-phase drives on shunt
// measurement, any; quantisation: Widrow, Kollar 2008. Cannot: settling of the amplifier after an edge,
// sampling one channel after the other, shunt heating.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "sim/drive/switched_drive.h"
#include "sim/law/random.h"

namespace omnihil {

enum class ShuntPlace : std::uint8_t { kPhase, kLowSide, kBus };

struct CurrentSensor {
  ShuntPlace place = ShuntPlace::kPhase;
  double shunt_ohm = 1e-3;
  double amplifier_gain = 20.0;
  double reference_V = 3.3;  // full scale of the ADC
  int bits = 12;
  double gain_error_ratio = 0.0;
  double offset_V = 0.0;       // at the ADC's input
  double noise_sigma_V = 0.0;  // at the ADC's input
};

struct AdcKey {
  std::uint64_t seed = 0;
  std::uint64_t stream = 0;
  std::uint64_t sample = 0;
};

// Before noise and rounding: a template on the scalar.
template <typename T>
T adc_input_V(const CurrentSensor& s, const T& current_A) {
  return 0.5 * s.reference_V + current_A * (s.shunt_ohm * s.amplifier_gain * (1.0 + s.gain_error_ratio)) +
         s.offset_V;
}

inline int adc_counts(const CurrentSensor& s, double current_A, const AdcKey& key) {
  double input_V = adc_input_V(s, current_A);
  if (s.noise_sigma_V > 0.0) input_V += s.noise_sigma_V * gaussian(key.seed, key.stream, key.sample);
  const double full = std::ldexp(1.0, s.bits), counts = std::floor(input_V * full / s.reference_V);
  return static_cast<int>(counts < 0.0 ? 0.0 : (counts > full - 1.0 ? full - 1.0 : counts));
}

inline double current_per_count_A(const CurrentSensor& s) {
  return s.reference_V / (std::ldexp(1.0, s.bits) * s.shunt_ohm * s.amplifier_gain);
}

// The middle of the count's interval, as firmware reckons it.
inline double current_of_counts(const CurrentSensor& s, int counts) {
  return (counts + 0.5 - 0.5 * std::ldexp(1.0, s.bits)) * current_per_count_A(s);
}

// The current that flows through the shunt of `phase` at the sampling instant (for kBus: of all legs).
inline double shunt_current_A(const CurrentSensor& s, const PeriodSample& sample, std::size_t phase) {
  if (s.place == ShuntPlace::kPhase) return sample.current_A[phase];
  if (s.place == ShuntPlace::kLowSide)
    return sample.leg[phase] == LegState::kLow ? sample.current_A[phase] : 0.0;
  double sum_A = 0.0;
  for (std::size_t x = 0; x < 3; ++x) {
    const bool upper_diode = sample.leg[x] == LegState::kOff && sample.current_A[x] < 0.0;
    if (sample.leg[x] == LegState::kHigh || upper_diode) sum_A += sample.current_A[x];
  }
  return sum_A;
}

}  // namespace omnihil
