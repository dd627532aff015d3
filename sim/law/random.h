// Counter-based random numbers: a pure function of (seed, stream, counter), so that noise is the same in any
// order of calls and on any number of threads.
//
//   double n = gaussian(seed, stream_of("motor_current"), sample_index);   // standard normal
//
// Method: SplitMix64's finaliser (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators")
// over a mix of the three keys; normals by Box and Muller (1958). Not for cryptography.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace omnihil {

constexpr std::uint64_t mix_bits(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15u;  // 2^64 / golden ratio, SplitMix64's increment
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  return mix_bits(mix_bits(mix_bits(seed) ^ stream) ^ counter);
}

// A stream's number from its name (FNV-1a).
constexpr std::uint64_t stream_of(std::string_view name) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return hash;
}

// Uniform in [0, 1).
constexpr double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  return static_cast<double>(random_bits(seed, stream, counter) >> 11) * 0x1.0p-53;
}

// Standard normal.
inline double gaussian(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  const double u = 1.0 - uniform(seed, stream, 2 * counter);  // in (0, 1]
  const double v = uniform(seed, stream, 2 * counter + 1);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

}  // namespace omnihil
