// Incremental encoder on the rotor: quadrature counts, the A, B and index lines, index pulses passed.
//
//   EncoderParams e{.counts_per_turn = 4096, .direction = 1, .index_offset_counts = 0};
//   std::int64_t counts = encoder_counts(e, theta_rotor_rad);
//
// Law: counts = floor(direction * theta * counts_per_turn / (2 pi)). A count's lower edge is the double
// n * (2 pi / counts_per_turn); the floor is taken against those edges themselves, so it is exact at every
// edge, for negative and for large angles, whichever way the division rounds.
// Lines: A leads B by a quarter period while counts rise (00, 10, 11, 01); the index line is high for the one
// count per turn whose number is index_offset_counts.
// Valid up to |counts| < 2^52. Cannot represent: uneven lines, missed edges, eccentricity, a finite edge
// rate.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sim/drive/motor_params.h"

namespace omnihil {

struct EncoderLines {
  bool a = false;
  bool b = false;
  bool index = false;
};

// The smallest angle, in the encoder's own direction, that reads `counts`.
inline double encoder_edge_rad(const EncoderParams& e, std::int64_t counts) {
  return static_cast<double>(counts) * (2.0 * std::numbers::pi / e.counts_per_turn);
}

inline std::int64_t encoder_counts(const EncoderParams& e, double theta_rotor_rad) {
  const double angle_rad = e.direction < 0 ? -theta_rotor_rad : theta_rotor_rad;
  auto counts =
      static_cast<std::int64_t>(std::floor(angle_rad * (e.counts_per_turn / (2.0 * std::numbers::pi))));
  while (encoder_edge_rad(e, counts) > angle_rad) --counts;
  while (encoder_edge_rad(e, counts + 1) <= angle_rad) ++counts;
  return counts;
}

namespace encoder_detail {
// a / b rounded down, b > 0.
inline std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return a % b < 0 ? quotient - 1 : quotient;
}
}  // namespace encoder_detail

inline EncoderLines encoder_lines(const EncoderParams& e, double theta_rotor_rad) {
  const std::int64_t counts = encoder_counts(e, theta_rotor_rad);
  const std::int64_t phase = counts - 4 * encoder_detail::floor_divide(counts, 4);
  const std::int64_t past_index = counts - e.index_offset_counts;
  return {.a = phase == 1 || phase == 2,
          .b = phase == 2 || phase == 3,
          .index = past_index % e.counts_per_turn == 0};
}

// Rising edges of the index line between two angles, in either direction. A turn back within the same count
// is not seen: both angles are samples, not a path.
inline std::int64_t index_pulses_between(const EncoderParams& e, double from_rad, double to_rad) {
  using encoder_detail::floor_divide;
  const std::int64_t from = encoder_counts(e, from_rad) - e.index_offset_counts;
  const std::int64_t to = encoder_counts(e, to_rad) - e.index_offset_counts;
  const std::int64_t turn = e.counts_per_turn;
  // multiples of a turn in (from, to], or in [to, from) when turning back
  if (to >= from) return floor_divide(to, turn) - floor_divide(from, turn);
  return floor_divide(from - 1, turn) - floor_divide(to - 1, turn);
}

}  // namespace omnihil
