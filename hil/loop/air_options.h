// What the radio does to packets, as a bench says it: options of `serve`, kept in recordings.
//
//   AirOptions air{.share = 0.02, .latency_least_s = 0.002, .latency_mean_s = 0.005};
//   const std::vector<std::string> problems = air_problems(air);
//
// What each means: air_loss.h, air_delay.h, air_bits.h.
#pragma once
#include <string>
#include <vector>

namespace omnihil {

enum class LatencyLaw { kExponential, kUniform, kLognormal };

struct AirOptions {
  double share = 0.0;  // lost, 0 to 1
  bool by_distance = false;
  double x_m = 0.0, y_m = 0.0;                                                  // of the transmitter
  double burst_good_packets = 0.0, burst_bad_packets = 0.0, burst_share = 0.0;  // 0: no bursts
  double others_load = 0.0;
  double latency_least_s = 0.0, latency_mean_s = 0.0;  // on top of the dongle's own times
  LatencyLaw latency_law = LatencyLaw::kExponential;   // of what is above the least
  double latency_sigma = 0.0;                          // kLognormal: of the logarithm
  bool in_order = false;                               // none overtakes another
  double twice_share = 0.0;                            // arrive a second time
  double held_share = 0.0, held_s = 0.0;               // held back by so much
  double bit_error_rate = 0.0;                         // 0 to 0.5

  bool delays() const { return latency_mean_s > 0.0 || twice_share > 0.0 || held_share > 0.0; }
  bool any() const {
    return share > 0.0 || by_distance || burst_bad_packets > 0.0 || others_load > 0.0 || delays() ||
           bit_error_rate > 0.0;
  }
  bool operator==(const AirOptions&) const = default;
};

// What is wrong with them, a line each.
std::vector<std::string> air_problems(const AirOptions& options);

}  // namespace omnihil
