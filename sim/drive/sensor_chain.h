// From a true signal to what a channel of a record holds: rounding of an encoder, noise of a known size.
//
//   double counts = encoder_reading(sample.encoder_counts);              // 12.7 -> 12
//   double volts = noisy(24.0, 0.02, seed, "bus_voltage", k);            // 24.0 + 0.02 n
#pragma once
#include <cmath>
#include <cstdint>
#include <string_view>

#include "sim/law/random.h"

namespace omnihil {

// floor: an encoder counts the edges it has passed
inline double encoder_reading(double counts) { return std::floor(counts); }

inline double noisy(double value, double sigma, std::uint64_t seed, std::string_view channel,
                    std::uint64_t sample) {
  return sigma > 0.0 ? value + sigma * gaussian(seed, stream_of(channel), sample) : value;
}

}  // namespace omnihil
