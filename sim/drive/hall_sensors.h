// Three Hall sensors that see the rotor's magnets: their levels, and what is wrong with them.
//
//   int code = hall_code(hall, theta_elec_rad);                      // H1 + 2 H2 + 4 H3
//   int sector = hall_sector(code);                                  // 0 .. 5, or -1 for 0 and 7
//   int read = hall_with_glitches(hall, code, {seed, stream, sample});
//
// Law: sensor x (at 0, 120, 240 electrical degrees) is high where 210 deg <= theta_elec - x - e_x < 390 deg,
// e_x = mounting error + the sensor's own offset. Without errors its edges are where a phase's back-EMF
// leaves or enters the middle 120 degrees of its half wave, so a sector is one block of the six-step
// commutation:
//   sector n: 60 n - 30 deg <= theta_elec < 60 n + 30 deg;   codes of sectors 0 .. 5: 3, 2, 6, 4, 5, 1
// Running forward the codes come in this order, backward 1, 5, 4, 6, 2, 3.
// A mounting error of e turns the current's vector by e: torque per ampere falls by cos e (sinusoidal).
// Glitch: with a given probability per sample one sensor reads inverted, a pure function of the key.
// Source: data sheets of bipolar Hall switches (180 degree pattern); Pillay and Krishnan 1989 for the blocks.
// Cannot: hysteresis of the switches, rise times, a magnet ring of its own with uneven poles.
#pragma once
#include <array>
#include <cstdint>
#include <numbers>

#include "sim/law/random.h"

namespace omnihil {

struct HallParams {
  double mounting_error_rad = 0.0;            // electrical, all three: the board is turned
  std::array<double, 3> sensor_offset_rad{};  // electrical, each; within +-60 degrees
  double glitch_probability = 0.0;            // per sample
};

struct HallKey {
  std::uint64_t seed = 0;
  std::uint64_t stream = 0;
  std::uint64_t sample = 0;
};

inline int hall_code(const HallParams& p, double theta_elec_rad) {
  constexpr double kTurnsPerRad = 0.5 / std::numbers::pi;
  const double turns = (theta_elec_rad - p.mounting_error_rad) * kTurnsPerRad - 210.0 / 360.0;
  const double part = turns - static_cast<double>(static_cast<std::int64_t>(turns));
  const double first = part < 0.0 ? part + 1.0 : part;
  int code = 0;
  for (int x = 0; x < 3; ++x) {
    // between -0.84 and 1.17 turns; in half turns, shifted to be positive: high where the whole part is even
    const double u =
        first - p.sensor_offset_rad[static_cast<std::size_t>(x)] * kTurnsPerRad - x * (1.0 / 3.0);
    code |= (~static_cast<int>(2.0 * u + 4.0) & 1) << x;
  }
  return code;
}

inline int hall_sector(int code) {
  constexpr std::array<int, 8> kSector = {-1, 5, 1, 0, 3, 4, 2, -1};
  return kSector[static_cast<std::size_t>(code & 7)];
}

// The two legs of a sector that turn the rotor forward: current into `high`, out of `low`. Phases 0, 1, 2.
struct BlockLegs {
  int high, low;
};
inline BlockLegs block_legs(int sector) {
  constexpr std::array<BlockLegs, 6> kPairs = {{{1, 2}, {1, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 2}}};
  return kPairs[static_cast<std::size_t>(sector)];
}

inline int hall_with_glitches(const HallParams& p, int code, const HallKey& key) {
  if (!(uniform(key.seed, key.stream, 2 * key.sample) < p.glitch_probability)) return code;
  return code ^ (1 << (random_bits(key.seed, key.stream, 2 * key.sample + 1) % 3));
}

}  // namespace omnihil
