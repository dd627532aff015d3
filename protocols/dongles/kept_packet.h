// One packet as a dongle keeps it: a copy of fixed capacity, no allocation.
//
//   const auto kept = KeptPacket<127>::of(bytes);      // at most 127 bytes
//   std::span<const std::uint8_t> copy = kept.span();
#pragma once
#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>

namespace omnihil {

template <std::size_t kBytes>
struct KeptPacket {
  static_assert(kBytes <= 65535);
  std::array<std::uint8_t, kBytes> bytes{};
  std::uint16_t size = 0;

  static KeptPacket of(std::span<const std::uint8_t> from) {
    assert(from.size() <= kBytes);
    KeptPacket kept;
    kept.size = static_cast<std::uint16_t>(from.size());
    std::copy(from.begin(), from.end(), kept.bytes.begin());
    return kept;
  }
  std::span<const std::uint8_t> span() const { return std::span(bytes).first(size); }
  std::span<std::uint8_t> span() { return std::span(bytes).first(size); }
};

}  // namespace omnihil
