// Counts that an encoder misses: the angle falls behind and stays behind.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/law/effect_entry.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

struct EncoderMissedCounts {
  enum Param { kProbability };
  enum State { kLost };
  static constexpr EffectParam kParams[] = {
      {.name = "probability_per_count",
       .unit = "1",
       .typical = 0.001,  // guess, a factor of 10 either way: none in a sound encoder
       .lower = 0,
       .upper = 0.1,
       .prior_scale = 0.001,
       .what = "probability that a count is not seen",
       .how = "turn there and back over many turns to a mark or an index pulse: the angle that is missing"},
  };
  static constexpr EffectState kStates[] = {{.name = "lost_rad", .unit = "rad"}};
  static constexpr EffectInfo kInfo{
      .id = "encoder_missed_counts",
      .title = "Missed encoder counts",
      .equation = "lost += direction * (2 pi / counts) * Poisson(p * counts passed); angle = theta - lost",
      .source = "Kingman, Poisson Processes, 1993 (rare independent losses); model: ours",
      .cannot =
          "losses that come in bursts or only at high speed, counts that are seen twice; direction is "
          "that at the end of a sample. Expected values (a fit) are p times the way",
      .place = Place::kSensor,
      .reveals =
          "long runs both ways with an index pulse or a second sensor: jumps of the angle that no "
          "torque could make; without a seed of noise its mean, a scale error of the angle",
      .visible = "a few counts lost in the record against an absolute reference",
      .min_visible =
          [](const SensorSet& s) {
            // Three counts in a record at 100 rad/s; coarse encoders pass fewer.
            return 3.0 / (s.counts_per_turn * 100.0 / 6.283185307179586 * s.duration_s);
          },
      .claims = kOdd | kRandom,
      .demands = kNeedsEncoder,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "encoder_error", .from_s = 0.0, .to_s = 2.0},
  };

  // A Poisson number of the given mean; rounded normal where that is near enough (error below 1 %).
  static double poisson(double mean, const NoiseKey& noise) {
    const std::uint64_t stream = noise.stream + stream_of("encoder_missed_counts");
    if (mean > 100.0) {
      return std::max(0.0,
                      std::floor(mean + std::sqrt(mean) * gaussian(noise.seed, stream, noise.sample) + 0.5));
    }
    // Inversion: P(k) = e^-m m^k / k!
    double left = uniform(noise.seed, stream, noise.sample);
    double part = std::exp(-mean);
    int k = 0;
    for (; left >= part && k < 1000; ++k) {
      left -= part;
      part *= mean / (k + 1);
    }
    return k;
  }

  template <typename T>
  static void apply(const T* p, T* x, SensorPort<T>& port) {
    const double direction = sign_of(port.omega_rotor_rad_s);
    // expected loss of the sample: p times the way
    T lost = p[kProbability] * port.travel_rad;
    if (port.noise != nullptr && value_of(port.counts_per_turn) > 0.0) {
      const T step_rad = 2.0 * std::numbers::pi / (port.counts_per_turn * port.encoder_turns_per_rotor_turn);
      const double mean = value_of(lost) / value_of(step_rad);
      // the number drawn, with the derivative of its expectation
      lost += step_rad * (poisson(mean, *port.noise) - mean);
    }
    x[kLost] += direction * lost;
    port.encoder_angle_rad -= x[kLost];
    if (port.speed_is_the_encoders && port.dt_s > 0.0)
      port.measured_speed_rad_s -= direction * lost / port.dt_s;
  }
};

}  // namespace

OMNIHIL_EFFECT(encoder_missed_counts, EncoderMissedCounts)

}  // namespace omnihil
