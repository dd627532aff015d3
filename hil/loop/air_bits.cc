#include "hil/loop/air_bits.h"

#include <cmath>

#include "sim/law/random.h"

namespace omnihil {

// Bits up to the next flip: P(k) = p (1 - p)^k, so k = floor(ln(1 - u) / ln(1 - p)).
bool AirBits::flip(std::span<std::uint8_t> packet) {
  if (rate_ <= 0.0) return false;
  constexpr std::uint64_t kStream = stream_of("air_bits");
  const double scale = 1.0 / std::log1p(-rate_);
  const double bits = 8.0 * static_cast<double>(packet.size());
  bool flipped = false;
  for (double bit = -1.0;;) {
    bit += 1.0 + std::floor(std::log1p(-uniform(seed_, kStream, drawn_++)) * scale);
    if (!(bit < bits)) return flipped;
    const auto at = static_cast<std::size_t>(bit);
    packet[at / 8] ^= static_cast<std::uint8_t>(1U << (at % 8));
    flipped = true;
  }
}

}  // namespace omnihil
