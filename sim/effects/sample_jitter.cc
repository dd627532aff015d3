// Samples that are not taken when their stamp says: earlier or later at random.
#include <cmath>

#include "sim/law/effect_entry.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

struct SampleJitter {
  enum Param { kSigma };
  static constexpr EffectParam kParams[] = {
      {.name = "sigma_s",
       .unit = "s",
       .typical = 0.0005,  // host clock of a desktop system: steps of 0.2 to 7 ms (measured)
       .lower = 0,
       .upper = 0.02,
       .prior_scale = 0.001,
       .what = "standard deviation of the sample instants about their stamps",
       .how = "histogram of the raw time stamps' differences; at constant speed, noise of the position over "
              "the speed",
       .trait = ParamTrait::kTime},
  };
  static constexpr EffectInfo kInfo{
      .id = "sample_jitter",
      .title = "Sample jitter",
      .equation = "t_k' = t_k + sigma n_k, n_k standard normal, independent",
      .source =
          "Souders, Flach, Hagwood, Yang, IEEE Trans. Instrum. Meas. 39(1), 1990 (error of a jittered "
          "sample: "
          "slope times time error)",
      .cannot =
          "be fitted by its expected value, which is no change at all: its size shows in the residual; "
          "clocks that drift, stamps that bunch",
      .place = Place::kTiming,
      .reveals =
          "constant speeds: noise of the position that grows in proportion to the speed, with random "
          "sign and no memory",
      .visible = "the noise of the position at 100 rad/s above the encoder's rounding",
      .min_visible =
          [](const SensorSet& s) {
            // sigma omega = count / sqrt(12) * (8 / n)^(1/4): variance ratio of two halves, three sigma
            const double step_rad = 6.283185307179586 / s.counts_per_turn;
            return step_rad / std::sqrt(12.0) / 100.0 * std::pow(8.0 / (s.rate_Hz * s.duration_s), 0.25);
          },
      .claims = kRandom,
      .numerics = kFine,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "encoder_error", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TimingPort<T>& port) {
    if (port.noise == nullptr) return;  // expected value: none
    const NoiseKey& n = *port.noise;
    // age = sigma n_k
    port.age_s += p[kSigma] * gaussian(n.seed, n.stream + stream_of("sample_jitter"), n.sample);
  }
};

}  // namespace

OMNIHIL_EFFECT(sample_jitter, SampleJitter)

}  // namespace omnihil
